"""Effects that sit in ball joints of an axle whose type is data: joints = ["TLO_L", "TLO_R"]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Literal

from doe_kc.axle.model import Axle
from doe_kc.axle.places import Places, ball_names, internal_ball
from doe_kc.effects._base import Effect
from doe_kc.effects._places import DEFAULT_PLACES
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.errors import InputError, nearest

BallLaw = Literal["elastic_balls", "play_balls"]
"""Balls of the topology that a law of the effect is given to."""


class BallEffect(Effect):
    """joints: those that have it, each with its side; none named: all."""

    def in_joints(
        self, axle: Axle, options: Mapping[str, Any], law: BallLaw, quantities: Mapping[str, str]
    ) -> Axle:
        """The axle with a law in the named joints. quantities: of a ball -> option that gives its value."""
        names = [internal_ball(joint) for joint in options["joints"]]
        values = {
            quantity_of(n, quantity): options[key] for n in names for quantity, key in quantities.items()
        }
        there: dict[str, Any] = {law: tuple(sorted({*getattr(axle.topology, law), *names}))}
        return replace(axle.changed(values), topology=replace(axle.topology, **there))

    def hypotheses(self, places: Places = DEFAULT_PLACES) -> tuple[Hypothesis, ...]:
        """Each ball joint, on both sides alike."""
        joints_of = {b.name: list(ball_names(places.structure, [b.name])) for b in places.structure.balls}
        return tuple(
            Hypothesis(self.id, name.upper(), self.sizes, {"joints": joints})
            for name, joints in joints_of.items()
            if joints
        )

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = DEFAULT_PLACES
    ) -> dict[str, Any]:
        checked = super().read(options, source, places)
        joints = checked["joints"] or list(places.balls)
        joints = list(joints) if isinstance(joints, list | tuple) else [joints]
        wrong = [name for name in joints if name not in places.balls]
        if wrong or not joints:
            hint = nearest(str(wrong[0]), places.balls) if wrong else ""
            raise InputError(
                f"{source}: effect {self.id}: joints = {joints!r}, expected a list of some of "
                f"{', '.join(places.balls)}.{hint}"
            )
        return checked | {"joints": joints}


def quantity_of(ball: str, quantity: str) -> str:
    """Internal name of a ball joint's quantity: `tlo@L`, `rate` -> `tlo.rate@L`."""
    name, mark, side = ball.partition("@")
    return f"{name}.{quantity}{mark}{side}"
