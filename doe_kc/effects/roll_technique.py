"""The roll record was made, or read, in another way than the model's roll case: technique."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places
from doe_kc.curves import CurveSet
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.load_cases.roll import PadRoll, Roll

OTHER_TECHNIQUES = ("counter_phase", "wheel_to_ground")


@effect
class RollTechnique(Effect):
    """Another roll technique; an axle whose roll case is not a body roll in deg stays as it is.

    counter_phase: the body stood still and the pads moved. wheel_to_ground: camber is against the road.
    """

    id: ClassVar[str] = "roll_technique"
    label: ClassVar[str] = "Other roll technique"
    part: ClassVar[Part] = "axle"
    options: ClassVar[Mapping[str, Option]] = {"technique": Option("counter_phase", choices=OTHER_TECHNIQUES)}
    on_rig: ClassVar[bool] = True

    physics: ClassVar[str] = (
        "The rig rolled the pads instead of the body, or gave camber against the road instead of the body."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("arb.radius", "rig_input_gain", "rig_channel_gain")
    shown_by: ClassVar[str] = "roll run both ways; camber in roll against camber of the same wheel travel"

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        return tuple(Hypothesis(self.id, None, (), {"technique": t}) for t in OTHER_TECHNIQUES)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        roll = axle.load_cases.get("roll")
        if options["technique"] != "counter_phase" or type(roll) is not Roll:
            return axle
        return replace(axle, load_cases={**axle.load_cases, "roll": PadRoll(**vars(roll))})

    def observe(self, curves: CurveSet, options: Mapping[str, Any]) -> CurveSet:
        roll = curves.cases.get("roll")
        if options["technique"] != "wheel_to_ground" or roll is None or roll.input_unit != Roll.unit:
            return curves
        # the right side goes down: the road leans the left wheel's top inwards, the right one's outwards
        road = np.array([[-1.0], [1.0]]) * roll.input
        mean = {**roll.mean, "camber": roll.mean["camber"] + road}
        return replace(curves, cases={**curves.cases, "roll": replace(roll, mean=mean)})
