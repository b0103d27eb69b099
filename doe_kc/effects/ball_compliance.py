"""Ball joints that sit in the part that carries them on springs equal in all directions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.effects._balls import BallEffect
from doe_kc.effects._base import Option, Part, effect
from doe_kc.effects.hypothesis import Size


@effect
class BallCompliance(BallEffect):
    """Ball-joint compliance of an axle whose type is data."""

    id: ClassVar[str] = "ball_compliance"
    label: ClassVar[str] = "Ball-joint compliance"
    part: ClassVar[Part] = "balls"
    options: ClassVar[Mapping[str, Option]] = {
        "joints": Option(()),
        "k_N_mm": Option(12000.0, "N/mm"),
    }

    physics: ClassVar[str] = (
        "A ball joint and what it sits in yield, so that the end of a link moves under load."
    )
    mistaken_for: ClassVar[tuple[str, ...]] = ("hub_compliance", "subframe_flexibility")
    shown_by: ClassVar[str] = "a dial gauge across the ball joint under the load case that shows it"
    sizes: ClassVar[tuple[Size, ...]] = (Size("k_N_mm", 12000.0, "N/mm", "compliance"),)

    def extend(self, axle: Axle, options: Mapping[str, Any]) -> Axle:
        return self.in_joints(axle, options, "elastic_balls", {"rate": "k_N_mm"})
