"""Ball joints that sit in the part that carries them on springs equal in all directions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from doe_kc.axle.model import Axle
from doe_kc.axle.places import internal_ball
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
        names = [internal_ball(joint) for joint in options["joints"]]
        values = {rate_of(name): options["k_N_mm"] for name in names}
        there = {*axle.topology.elastic_balls, *names}
        topology = replace(axle.topology, elastic_balls=tuple(sorted(there)))
        return replace(axle.changed(values), topology=topology)


def rate_of(ball: str) -> str:
    """Internal name of a ball joint's stiffness: `tlo@L` -> `tlo.rate@L`."""
    name, mark, side = ball.partition("@")
    return f"{name}.rate{mark}{side}"
