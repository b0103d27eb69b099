"""Static angles that the rig reads with an offset, on both sides: toe_deg = 0.1."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places
from doe_kc.curves import CurveSet
from doe_kc.effects._base import Effect, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects._tables import named_numbers
from doe_kc.effects.hypothesis import Hypothesis, Size

OFFSET_KEYS = {f"{name}_deg": name for name in ("toe", "camber", "spin")}


@effect
class RigChannelOffset(Effect):
    """Offset of the static alignment; curves hold changes from static and do not see it."""

    id: ClassVar[str] = "rig_channel_offset"
    label: ClassVar[str] = "Offset of the static alignment"
    part: ClassVar[Part] = "axle"
    on_rig: ClassVar[bool] = True
    odds: ClassVar[float] = 0.05

    physics: ClassVar[str] = (
        "The rig's zero of an angle is off, so that the static alignment is read wrongly."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("static.toe", "static.camber", "bushing_preload")
    shown_by: ClassVar[str] = "the wheels' alignment measured on another rig, or with the car turned around"

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        return tuple(
            Hypothesis(self.id, name, (Size(key, 0.1, "deg", signed=True),))
            for key, name in OFFSET_KEYS.items()
        )

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        return self.read(before, axle.name) | self.read(after, axle.name)

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        return named_numbers(
            options or {"toe_deg": 0.1}, OFFSET_KEYS, f"{source}: effect {self.id}", "an angle"
        )

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return axle

    def observe(self, curves: CurveSet, options: Mapping[str, Any]) -> CurveSet:
        if curves.static is None:
            return curves
        offsets = {OFFSET_KEYS[key]: value for key, value in options.items()}
        static = {name: value + offsets.get(name, 0.0) for name, value in curves.static.items()}
        return replace(curves, static=static)
