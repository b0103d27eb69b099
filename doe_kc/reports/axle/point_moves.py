"""The axle before and after, and how far each of its hardpoints moved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from doe_kc.axle.geometry import point
from doe_kc.axle.members import drawn_points
from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import with_values
from doe_kc.correlation.result import Correlation
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.correlation.parameters import parameter_rows

LONGEST_ARROW = 100.0
"""mm of the axle that the longest arrow takes at most; its factor is the next smaller round one."""
ARROW_FACTORS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
SHOWN_MOVE = 0.05
"""mm; a point that moved less has no arrow: points are measured to a tenth."""


@dataclass(frozen=True)
class PointMove:
    """A hardpoint of the left side, all (3,) mm. place: as it was. sd: of the move, nan where not known."""

    name: str
    place: FloatArray
    move: FloatArray
    sd: FloatArray

    @property
    def distance(self) -> float:
        """Length of the move, mm."""
        return float(np.linalg.norm(self.move))


@dataclass(frozen=True)
class AxleView:
    """after: None where nothing is compared. sd: parameter path -> standard deviation in mm."""

    title: str
    before: Axle
    after: Axle | None = None
    sd: Mapping[str, float] = field(default_factory=dict)

    @property
    def moves(self) -> list[PointMove]:
        """Of every hardpoint of the left side, in the order of the thesis's Table 1."""
        last = self.after or self.before
        return [
            PointMove(
                name,
                point(self.before, name),
                point(last, name) - point(self.before, name),
                np.array([self.sd.get(f"{name}.{axis}", np.nan) for axis in "xyz"]),
            )
            for name in drawn_points(self.before)
        ]

    @property
    def factor(self) -> int:
        """By which moves are drawn longer than they are."""
        longest = max((m.distance for m in self.moves), default=0.0)
        fitting = [f for f in ARROW_FACTORS if f * longest <= LONGEST_ARROW]
        return fitting[-1] if fitting and longest >= SHOWN_MOVE else 1


def correlation_view(correlation: Correlation, study: str) -> AxleView:
    """The axle that a correlation was given and the one that it hands over."""
    first = correlation.problem.axle
    space = correlation.problem.space
    return AxleView(
        f"The axle before and after: {study}",
        with_values(first, space.values(correlation.baseline.point)),
        correlation.axle,
        {r.path: r.sd for r in parameter_rows(correlation)},
    )
