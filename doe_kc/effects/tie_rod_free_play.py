"""Free play in the outer tie-rod joints: joints = ["ROB_L", "ROB_R"], gap_mm between the contacts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.effects._base import Effect, Option, effect
from doe_kc.errors import InputError

JOINTS = ("ROB_L", "ROB_R")


@effect
class TieRodFreePlay(Effect):
    """Tie-rod free play."""

    id: ClassVar[str] = "tie_rod_free_play"
    label: ClassVar[str] = "Tie-rod free play"
    table: ClassVar[str] = "free_play"
    options: ClassVar[Mapping[str, Option]] = {"joints": Option(JOINTS), "gap_mm": Option(0.2, "mm")}

    def read(self, given: Mapping[str, Any], source: str) -> dict[str, Any]:
        options = super().read(given, source)
        joints = options["joints"]
        joints = list(joints) if isinstance(joints, list | tuple) else [joints]
        wrong = [j for j in joints if j not in JOINTS]
        if wrong or not joints:
            raise InputError(
                f"{source}: effect {self.id}: joints = {joints!r}, expected a list of {', '.join(JOINTS)}."
            )
        return options | {"joints": joints}

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        topology = replace(
            axle.topology,
            free_play_left="ROB_L" in options["joints"],
            free_play_right="ROB_R" in options["joints"],
        )
        return replace(axle.changed(both("tie_rod.gap", options["gap_mm"])), topology=topology)
