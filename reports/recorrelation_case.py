"""One disturbed car of the re-correlation study, with its runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from correlation_runs import Trace
from recovery import Fit

from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Case:
    """One disturbed car. All (d,) in prior sd about nominal: moved, the truth; points of the runs `ego`.

    fine: runs of `ego` with continuous variables.

    seen: singular values of the whitened Jacobian at the truth, rig noise, in prior sd, falling; axes:
    (d, d) their directions in columns. visible: what records of that noise would see.
    """

    times: float
    car: int
    active: int
    paths: list[str]
    moved: FloatArray
    prior: FloatArray
    start: FloatArray
    seen: FloatArray
    axes: FloatArray
    visible: FloatArray
    ego: list[Trace]
    fine: list[Trace]
    newton: Trace
    fit: Fit

    def left(self, point: Sequence[float]) -> FloatArray:
        """(d,) estimate minus truth of a run's final point, in prior sd."""
        return (np.array(point) - self.start) / self.prior - self.moved
