"""Factor on the translational stiffnesses of one side's bushing: scale = { LLR_R = 1.25 }."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places, places_of
from doe_kc.effects._base import Effect, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects._tables import named_numbers
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.errors import InputError


@effect
class LeftRightAsymmetry(Effect):
    """Left/right asymmetry of a bushing."""

    id: ClassVar[str] = "left_right_asymmetry"
    label: ClassVar[str] = "Left/right asymmetry"
    part: ClassVar[Part] = "axle"
    table: ClassVar[str] = "asymmetry"

    physics: ClassVar[str] = (
        "A bushing of one side is stiffer or softer than its twin, so that the wheels answer equal loads "
        "differently."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("bushing_preload", "bushing_progression", "tie_rod_free_play")
    shown_by: ClassVar[str] = "the bushings of both sides exchanged: the difference changes sides with them"

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        return tuple(
            Hypothesis(self.id, key, (Size(key, 1.25, "-", "factor", signed=True),))
            for key in places.bushing_sides
        )

    def combined(self, before: Mapping[str, Any], after: Mapping[str, Any], axle: Axle) -> dict[str, Any]:
        one, other = (self.read(o, axle.name, places_of(axle)) for o in (before, after))
        return {k: one.get(k, 1.0) * other.get(k, 1.0) for k in one | other}

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        nested = options.get("scale", {})
        if not isinstance(nested, Mapping):
            raise InputError(f"{source}: effect {self.id}: scale = {nested!r}, expected {{ LLR_R = 1.25 }}.")
        flat = {k.removeprefix("scale."): v for k, v in options.items() if k != "scale"} | dict(nested)
        where = f"{source}: effect {self.id}"
        return named_numbers(
            flat or self._default(places), places.bushing_sides, where, "a bushing of one side", positive=True
        )

    @staticmethod
    def _default(places: Places) -> dict[str, float]:
        """The rear lower bushing of the right side, or the first right one of another type."""
        keys = [key for key in places.bushing_sides if key.endswith("_R")]
        return {"LLR_R" if "LLR_R" in keys else keys[0]: 1.25}

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values = {}
        for key, factor in options.items():
            bushing, side = places_of(axle).bushing_sides[key]
            for axis in ("Fx", "Fy", "Fz"):
                name = f"{bushing}.{axis}@{side}"
                values[name] = axle.values[name] * factor
        return axle.changed(values)
