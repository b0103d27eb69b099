"""Responses that the rig reads with a wrong gain, in all load cases and on both sides: toe = 1.05."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places
from doe_kc.curves import RIG_RESPONSES, CaseCurves, CurveSet
from doe_kc.effects._base import Effect, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects._tables import named_numbers
from doe_kc.effects.hypothesis import Hypothesis, Size


@effect
class RigChannelGain(Effect):
    """Wrong gain of a measuring channel.

    It scales changes from static, the tyre load as a whole; the static alignment is measured otherwise.
    """

    id: ClassVar[str] = "rig_channel_gain"
    label: ClassVar[str] = "Wrong gain of a measuring channel"
    part: ClassVar[Part] = "axle"
    on_rig: ClassVar[bool] = True
    odds: ClassVar[float] = 0.05

    physics: ClassVar[str] = "The rig's sensor of one response is calibrated wrongly."
    mistaken_for: ClassVar[tuple[str, ...]] = ("rig_input_gain", "steering_ratio", "roll_technique")
    shown_by: ClassVar[str] = "the channel against a gauge of known size; one gain in every load case"

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        return tuple(
            Hypothesis(self.id, name, (Size(name, 1.05, "-", "factor", signed=True),))
            for name in RIG_RESPONSES
        )

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        return self.read(before, axle.name) | self.read(after, axle.name)

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        where = f"{source}: effect {self.id}"
        return named_numbers(options or {"toe": 1.05}, RIG_RESPONSES, where, "a response", positive=True)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return axle

    def observe(self, curves: CurveSet, options: Mapping[str, Any]) -> CurveSet:
        gains = self.reading_gains(options)
        return replace(curves, cases={i: _scaled(c, gains) for i, c in curves.cases.items()})

    def reading_gains(self, options: Mapping[str, Any]) -> Mapping[str, float]:
        return options


def _scaled(case: CaseCurves, gains: Mapping[str, float]) -> CaseCurves:
    mean = {name: gains.get(name, 1.0) * curve for name, curve in case.mean.items()}
    half = {name: gains.get(name, 1.0) * curve for name, curve in case.half_width.items()}
    return replace(case, mean=mean, half_width=half)
