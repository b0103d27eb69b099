"""All variables together: from the unit cube to absolute parameter values and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.variables.variable import Variable


@dataclass(frozen=True)
class Tie:
    """`follower` keeps its offset from `leader`, or their ratio when `ratio`.

    follower_nominal, leader_nominal: absolute values of the unchanged axle.
    """

    follower: str
    leader: str
    ratio: bool
    follower_nominal: float
    leader_nominal: float

    def value(self, leader: float) -> float:
        """Absolute value of the follower."""
        if self.ratio:
            return self.follower_nominal * leader / self.leader_nominal
        return self.follower_nominal + leader - self.leader_nominal

    @property
    def slope(self) -> float:
        """d follower / d leader."""
        return self.follower_nominal / self.leader_nominal if self.ratio else 1.0


@dataclass(frozen=True)
class Space:
    """d variables, the ties to them, and parameters held at a value. Points are (d,) in [0, 1]."""

    variables: tuple[Variable, ...]
    ties: tuple[Tie, ...] = ()
    fixed: Mapping[str, float] | None = None

    @property
    def dimension(self) -> int:
        """d, the number of variables."""
        return len(self.variables)

    @property
    def paths(self) -> tuple[str, ...]:
        """(d,) parameter paths."""
        return tuple(v.path for v in self.variables)

    @property
    def start(self) -> FloatArray:
        """(d,) the first design."""
        return np.array([v.place(v.start) for v in self.variables])

    @property
    def prior_sd(self) -> FloatArray:
        """(d,) standard deviation of each variable before any measurement."""
        return np.array([v.prior_sd for v in self.variables])

    def started(self, values: Mapping[str, float]) -> Space:
        """The space about other starts (absolute): bounds shift with them; what is no variable is fixed."""
        moved = tuple(v.started(values[v.path]) if v.path in values else v for v in self.variables)
        held = {path: value for path, value in values.items() if path not in self.paths}
        return replace(self, variables=moved, fixed={**(self.fixed or {}), **held})

    def widened(self, factor: float) -> Space:
        """The space with all ranges `factor` times as wide, see `Variable.widened`."""
        return replace(self, variables=tuple(v.widened(factor) for v in self.variables))

    def values(self, unit: FloatArray) -> dict[str, float]:
        """Path -> absolute value of every variable, tied and fixed parameter at a point (d,)."""
        out = {v.path: v.value(float(u)) for v, u in zip(self.variables, unit, strict=True)}
        out |= {tie.follower: tie.value(out[tie.leader]) for tie in self.ties}
        return out | dict(self.fixed or {})

    def unit(self, values: Mapping[str, float]) -> FloatArray:
        """(d,) point of absolute values; KeyError for a variable that is not among them."""
        return np.array([v.place(values[v.path]) for v in self.variables])

    def slopes(self, unit: FloatArray) -> FloatArray:
        """(d,) d value / d u of each variable at a point."""
        return np.array([v.slope(float(u)) for v, u in zip(self.variables, unit, strict=True)])

    def snapped(self, unit: FloatArray) -> FloatArray:
        """(..., d) points with every variable at its nearest level, inside the bounds."""
        inside = np.clip(unit, 0.0, 1.0)
        steps = np.array([np.inf if v.levels is None else v.levels - 1.0 for v in self.variables])
        with np.errstate(invalid="ignore"):
            return np.where(np.isinf(steps), inside, np.round(inside * steps) / steps)

    def drawn(self, probability: FloatArray) -> FloatArray:
        """(n, d) points of cumulative probabilities, each variable by its own distribution."""
        columns = [v.drawn(probability[:, i]) for i, v in enumerate(self.variables)]
        return np.column_stack(columns) if columns else np.zeros((len(probability), 0))
