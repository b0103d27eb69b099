"""Rack housing that slides along the sub-frame's Y on a spring; rack and pinion ride on it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._base import Effect, Option, effect
from doe_kc.effects.hypothesis import Size


@effect
class RackMountCompliance(Effect):
    """Rack-mount compliance."""

    id: ClassVar[str] = "rack_mount_compliance"
    label: ClassVar[str] = "Rack-mount compliance"
    table: ClassVar[str] = "rack_mount"
    options: ClassVar[Mapping[str, Option]] = {
        "k_N_mm": Option(6000.0, "N/mm"),
    }

    physics: ClassVar[str] = (
        "The rack housing shifts in its rubber mounts under the tie rods' sum, so that both wheels steer the "
        "same way."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("scb.Tz", "tie_rod_compliance", "subframe_flexibility")
    shown_by: ClassVar[str] = "a dial gauge between rack housing and sub-frame under lateral force in phase"
    sizes: ClassVar[tuple[Size, ...]] = (Size("k_N_mm", 6000.0, "N/mm", "compliance"),)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed({"rack_mount.rate": options["k_N_mm"]})
        return replace(changed, topology=replace(axle.topology, rack_mount=True))
