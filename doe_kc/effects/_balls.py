"""Effects that sit in ball joints of an axle whose type is data: joints = ["TLO_L", "TLO_R"]."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from doe_kc.axle.places import MCPHERSON_PLACES, Places, ball_names
from doe_kc.effects._base import Effect
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.errors import InputError, nearest


class BallEffect(Effect):
    """joints: those that have it, each with its side; none named: all."""

    def hypotheses(self, places: Places = MCPHERSON_PLACES) -> tuple[Hypothesis, ...]:
        """Each ball joint, on both sides alike."""
        structure = places.structure
        if structure is None:
            return ()
        return tuple(
            Hypothesis(
                self.id, ball.name.upper(), self.sizes, {"joints": list(ball_names(structure, [ball.name]))}
            )
            for ball in structure.balls
        )

    def read(
        self, options: Mapping[str, Any], source: str, places: Places = MCPHERSON_PLACES
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
