"""Rotation springs between knuckle and damper tube at the strut clamp."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class StrutBending(Effect):
    """Strut bending at the clamp."""

    id: ClassVar[str] = "strut_bending"
    part: ClassVar[Part] = "strut"
    label: ClassVar[str] = "Strut bending at the clamp"
    options: ClassVar[Mapping[str, Option]] = {
        "k_Nm_deg": Option(8000.0, "Nm/deg"),
        "torsion_Nm_deg": Option(30000.0, "Nm/deg"),
    }

    physics: ClassVar[str] = (
        "The damper bends and twists in its clamp, so that the wheel tilts and steers against the top mount."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("strut.flexibility", "hub_compliance", "upb.Fy", "upb.Fx")
    shown_by: ClassVar[str] = "a target on the damper tube above the clamp and one on the knuckle below it"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("k_Nm_deg", 8000.0, "Nm/deg", "compliance"),
        Size("torsion_Nm_deg", 30000.0, "Nm/deg", "compliance"),
    )
    replaces: ClassVar[tuple[str, ...]] = ("strut.flexibility",)

    def present(self, axle: Axle) -> bool:
        return axle.topology.strut_bending

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            both("strut.flexibility", 1.0)
            | both("strut.bending", options["k_Nm_deg"])
            | both("strut.torsion", options["torsion_Nm_deg"])
        )
        return replace(changed, topology=replace(axle.topology, strut_bending=True))
