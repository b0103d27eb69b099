"""Factor on the translational stiffnesses of one side's bushing: scale = { LLR_R = 1.25 }."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import BUSHINGS, Axle
from doe_kc.effects._base import Effect, checked_number, effect
from doe_kc.errors import InputError, nearest

KEYS = {f"{name.upper()}_{side}": (name, side) for name in BUSHINGS for side in "LR"}


@effect
class LeftRightAsymmetry(Effect):
    """Left/right asymmetry of a bushing."""

    id: ClassVar[str] = "left_right_asymmetry"
    label: ClassVar[str] = "Left/right asymmetry"
    table: ClassVar[str] = "asymmetry"

    def read(self, given: Mapping[str, Any], source: str) -> dict[str, Any]:
        nested = given.get("scale", {})
        if not isinstance(nested, Mapping):
            raise InputError(f"{source}: effect {self.id}: scale = {nested!r}, expected {{ LLR_R = 1.25 }}.")
        flat = {k.removeprefix("scale."): v for k, v in given.items() if k != "scale"} | dict(nested)
        for key in flat:
            if key not in KEYS:
                raise InputError(
                    f"{source}: effect {self.id}: {key!r} is not a bushing of one side; "
                    f"expected one of {', '.join(KEYS)}.{nearest(key, KEYS)}"
                )
        flat = flat or {"LLR_R": 1.25}
        return {
            k: checked_number(v, f"{source}: effect {self.id}: {k} = {v!r}", positive=True)
            for k, v in flat.items()
        }

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        values = {}
        for key, factor in options.items():
            bushing, side = KEYS[key]
            for axis in ("Fx", "Fy", "Fz"):
                name = f"{bushing}.{axis}@{side}"
                values[name] = axle.values[name] * factor
        return axle.changed(values)
