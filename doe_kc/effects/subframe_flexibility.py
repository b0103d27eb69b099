"""Left and right halves on a centre part that carries the rack; springs at the mean mount point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size

JOINT_STIFFNESS = {
    "kx": 2 * 40000.0,
    "ky": 2 * 40000.0,
    "kz": 2 * 20000.0,
    "krx": 2 * 1500.0,
    "kry": 2 * 3000.0,
    "krz": 2 * 6000.0,
}
"""N/mm and Nm/deg of each half's joint for `scale` 1."""


@effect
class SubframeFlexibility(Effect):
    """Sub-frame flexibility."""

    id: ClassVar[str] = "subframe_flexibility"
    label: ClassVar[str] = "Sub-frame flexibility"
    part: ClassVar[Part] = "subframe"
    table: ClassVar[str] = "subframe"
    options: ClassVar[Mapping[str, Option]] = {
        "mode": Option("flexible", choices=("flexible", "rigid")),
        "scale": Option(1.0, "-"),
    }

    physics: ClassVar[str] = (
        "The sub-frame is no rigid part: its halves give way under the arms' forces and steer the wheels."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("hub_compliance", "rack_mount_compliance", "sff.Fy", "llf.Fx")
    shown_by: ClassVar[str] = "lateral force in phase against in opposition; targets on both sub-frame halves"
    sizes: ClassVar[tuple[Size, ...]] = (Size("scale", 1.0, "-", "compliance"),)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        if options["mode"] == "rigid":
            return replace(axle, topology=replace(axle.topology, flexible_subframe=False))
        values = {f"subframe.{key}": options["scale"] * k for key, k in JOINT_STIFFNESS.items()}
        return replace(axle.changed(values), topology=replace(axle.topology, flexible_subframe=True))
