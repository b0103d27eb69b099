"""Load cases whose input the rig gives wrongly by a factor: lateral = 1.05 for 5 % more than it says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places
from doe_kc.effects._base import Effect, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects._tables import named_numbers
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.load_cases import CASE_ORDER


@effect
class RigInputGain(Effect):
    """Wrong input of a load case: what is read at u belongs to the true input g u."""

    id: ClassVar[str] = "rig_input_gain"
    label: ClassVar[str] = "Wrong input of a load case"
    part: ClassVar[Part] = "axle"
    on_rig: ClassVar[bool] = True
    odds: ClassVar[float] = 0.05

    physics: ClassVar[str] = "The rig applied more or less than it recorded in one load case."
    mistaken_for: ClassVar[tuple[str, ...]] = ("rig_channel_gain", "steering_ratio", "arb.radius")
    shown_by: ClassVar[str] = "the actuator's load cell or encoder checked; one factor in every response"

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        return tuple(
            Hypothesis(self.id, name, (Size(name, 1.05, "-", "factor", signed=True),))
            for name in CASE_ORDER
            if name != "steer" or places.rack
        )

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        return self.read(before, axle.name) | self.read(after, axle.name)

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        where = f"{source}: effect {self.id}"
        return named_numbers(options or {"lateral": 1.05}, CASE_ORDER, where, "a load case", positive=True)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        cases = axle.load_cases
        wrong = {i: replace(cases[i], gain=gain) for i, gain in options.items() if i in cases}
        return replace(axle, load_cases={**cases, **wrong})
