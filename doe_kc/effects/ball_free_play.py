"""Free play in ball joints, along the line between the two points of the joint."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._balls import BallEffect
from doe_kc.effects._base import Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class BallFreePlay(BallEffect):
    """Ball-joint free play of an axle whose type is data."""

    id: ClassVar[str] = "ball_free_play"
    label: ClassVar[str] = "Ball-joint free play"
    part: ClassVar[Part] = "balls"
    options: ClassVar[Mapping[str, Option]] = {
        "joints": Option(()),
        "gap_mm": Option(0.2, "mm"),
        "contact_N_mm": Option(20000.0, "N/mm"),
    }

    physics: ClassVar[str] = (
        "A worn ball joint has play, so that its link lets go where its force changes sign."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("ball_compliance", "bushing_progression")
    shown_by: ClassVar[str] = "the wheel rocked by hand, a dial gauge across the ball joint"
    sizes: ClassVar[tuple[Size, ...]] = (
        Size("gap_mm", 0.2, "mm", needed=True),
        Size("contact_N_mm", 20000.0, "N/mm", "compliance"),
    )

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return self.in_joints(axle, options, "play_balls", {"gap": "gap_mm", "contact": "contact_N_mm"})
