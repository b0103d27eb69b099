"""Rack housing that slides along the sub-frame's Y on a spring; rack and pinion ride on it.

The mount's force is k h (1 + c q / (1 + q)), q = (h / reference)^2: it grows stiffer by the share c far out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects.hypothesis import Size
from doe_kc.ground.errors import InputError

SOFTEST = -0.88
"""Stiffening at which the slope of the mount's force, at least k (1 + 9/8 c), is nearly zero."""


@effect
class RackMountCompliance(Effect):
    """Rack-mount compliance."""

    id: ClassVar[str] = "rack_mount_compliance"
    label: ClassVar[str] = "Rack-mount compliance"
    part: ClassVar[Part] = "rack"
    spring: ClassVar[tuple[str, ...]] = ("steering.column", "scb.Tz")
    table: ClassVar[str] = "rack_mount"
    options: ClassVar[Mapping[str, Option]] = {
        "k_N_mm": Option(6000.0, "N/mm"),
        "stiffening": Option(0.0, "-", positive=False),
        "reference_mm": Option(0.2, "mm"),
    }

    physics: ClassVar[str] = (
        "The rack housing shifts in its rubber mounts under the tie rods' sum, so that both wheels steer the "
        "same way."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("scb.Tz", "tie_rod_compliance", "subframe_flexibility")
    shown_by: ClassVar[str] = "a dial gauge between rack housing and sub-frame under lateral force in phase"
    sizes: ClassVar[tuple[Size, ...]] = (
        # every mount yields; a softer column says so, but not beside a friction or an assist of the rack
        Size("k_N_mm", 6000.0, "N/mm", "compliance", present=True),
        Size("stiffening", 0.15, "-", "bend", most=2.5),
    )

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read(options, source, places)
        if checked["stiffening"] <= SOFTEST:
            raise InputError(
                f"{source}: effect {self.id}: stiffening = {checked['stiffening']:g}, expected more than "
                f"{SOFTEST}: the mount's force would fall while it deflects further."
            )
        return checked

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        changed = axle.changed(
            {
                "rack_mount.rate": options["k_N_mm"],
                "rack_mount.stiffening": options["stiffening"],
                "rack_mount.reference": options["reference_mm"],
            }
        )
        return replace(changed, topology=replace(axle.topology, rack_mount=True))
