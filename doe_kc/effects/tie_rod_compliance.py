"""Axial spring in both tie rods: lengthening = tension / k."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class TieRodCompliance(Effect):
    """Tie-rod compliance."""

    id: ClassVar[str] = "tie_rod_compliance"
    label: ClassVar[str] = "Tie-rod compliance"
    part: ClassVar[Part] = "rods"
    options: ClassVar[Mapping[str, Option]] = {"k_N_mm": Option(15000.0, "N/mm")}

    physics: ClassVar[str] = (
        "Tie rod and ball sockets stretch under their own force, so that each wheel steers with its own load."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("steer_arm_compliance", "rack_mount_compliance", "scb.Tz")
    shown_by: ClassVar[str] = "force over length of the tie rod with its joints on a test bench"
    sizes: ClassVar[tuple[Size, ...]] = (Size("k_N_mm", 15000.0, "N/mm", "compliance"),)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return axle.changed(both("tie_rod.flexibility", 1.0 / options["k_N_mm"]))
