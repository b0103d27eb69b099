"""Free play in the outer tie-rod joints: joints = ["ROB_L", "ROB_R"], gap_mm between the contacts.

A ball that has play also yields where it touches; its contact stiffness is a size of its own, so that the
effect fades into a rigid rod.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle, both
from doe_kc.axle.places import Places
from doe_kc.effects._base import Effect, Option, Part, effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.errors import InputError

JOINTS = ("ROB_L", "ROB_R")


@effect
class TieRodFreePlay(Effect):
    """Tie-rod free play."""

    id: ClassVar[str] = "tie_rod_free_play"
    label: ClassVar[str] = "Tie-rod free play"
    part: ClassVar[Part] = "rods"
    table: ClassVar[str] = "free_play"
    options: ClassVar[Mapping[str, Option]] = {
        "joints": Option(JOINTS),
        "gap_mm": Option(0.2, "mm"),
        "contact_N_mm": Option(20000.0, "N/mm"),
    }

    physics: ClassVar[str] = (
        "A worn tie-rod ball has play, so that toe jumps where the rod's force changes sign."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = (
        "tie_rod_compliance",
        "steering_friction",
        "bushing_progression",
    )
    shown_by: ClassVar[str] = "the wheel rocked by hand about the vertical, a dial gauge across the ball"

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        sizes = (
            Size("gap_mm", 0.2, "mm", needed=True),
            Size("contact_N_mm", 20000.0, "N/mm", "compliance"),
        )
        del places
        joints_of = {"ROB": list(JOINTS)} | {joint: [joint] for joint in JOINTS}
        return tuple(Hypothesis(self.id, p, sizes, {"joints": joints}) for p, joints in joints_of.items())

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read(options, source, places)
        joints = checked["joints"]
        joints = list(joints) if isinstance(joints, list | tuple) else [joints]
        wrong = [j for j in joints if j not in JOINTS]
        if wrong or not joints:
            raise InputError(
                f"{source}: effect {self.id}: joints = {joints!r}, expected a list of {', '.join(JOINTS)}."
            )
        return checked | {"joints": joints}

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        topology = replace(
            axle.topology,
            free_play_left="ROB_L" in options["joints"],
            free_play_right="ROB_R" in options["joints"],
        )
        values = both("tie_rod.gap", options["gap_mm"]) | both("tie_rod.contact", options["contact_N_mm"])
        return replace(axle.changed(values), topology=topology)
