"""Load cases whose input the rig gives wrongly by a factor: lateral = 1.05 for 5 % more than it says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.effects._base import Effect, effect
from doe_kc.effects._tables import named_numbers
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.solver.load_cases import CASE_ORDER
from doe_kc.typing import FloatArray


@effect
class RigInputGain(Effect):
    """Wrong input of a load case: what is read at u belongs to the true input g u."""

    id: ClassVar[str] = "rig_input_gain"
    label: ClassVar[str] = "Wrong input of a load case"
    on_rig: ClassVar[bool] = True
    odds: ClassVar[float] = 0.05

    physics: ClassVar[str] = "The rig applied more or less than it recorded in one load case."
    mistaken_for: ClassVar[tuple[str, ...]] = ("rig_channel_gain", "steering_ratio", "arb.radius")
    shown_by: ClassVar[str] = "the actuator's load cell or encoder checked; one factor in every response"

    def hypotheses(self) -> tuple[Hypothesis, ...]:
        return tuple(
            Hypothesis(self.id, name, (Size(name, 1.05, "-", "factor", signed=True),)) for name in CASE_ORDER
        )

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        return self.read(before, axle.name) | self.read(after, axle.name)

    def read(self, given: Mapping[str, Any], source: str) -> dict[str, Any]:
        where = f"{source}: effect {self.id}"
        return named_numbers(given or {"lateral": 1.05}, CASE_ORDER, where, "a load case", positive=True)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return axle

    def observe(self, curves: CurveSet, options: Mapping[str, Any]) -> CurveSet:
        return replace(
            curves,
            cases={i: _stretched(c, options[i]) if i in options else c for i, c in curves.cases.items()},
        )


def _stretched(case: CaseCurves, gain: float) -> CaseCurves:
    """Half-widths stay: a loop closes at the ends of its sweep, wherever those are."""
    mean = {
        name: np.array([_extended(gain * case.input, case.input, row) for row in curve])
        for name, curve in case.mean.items()
    }
    return replace(case, mean=mean)


def _extended(at: FloatArray, grid: FloatArray, row: FloatArray) -> FloatArray:
    """Straight lines between the points of a curve and beyond its ends."""
    right = np.clip(np.searchsorted(grid, at), 1, grid.size - 1)
    slope = (row[right] - row[right - 1]) / (grid[right] - grid[right - 1])
    return np.asarray(row[right - 1] + slope * (at - grid[right - 1]))
