"""Roll motion, by body rotation (the rig's technique) or by counter-phase pads (ADAMS/Car's)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases._base import (
    Controls,
    Datum,
    LoadCase,
    held_pads,
    load_case,
)


@dataclass(frozen=True)
class Roll(LoadCase):
    """The body turns about y = 0, z = 0, pads stay in the ground plane; + = right side down, deg."""

    id: ClassVar[str] = "roll"
    label: ClassVar[str] = "Roll motion"
    channel: ClassVar[str] = "roll"
    unit: ClassVar[str] = "deg"
    input_label: ClassVar[str] = "Body roll (right side down +)"
    window: ClassVar[float] = 1.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return held_pads(static) | {"roll": np.radians(value)}


@dataclass(frozen=True)
class CounterPhaseRoll(LoadCase):
    """The body is held, the pads move against each other; + = right pad up, mm of each pad.

    Rolls the same way as a positive body roll.
    """

    id: ClassVar[str] = "roll"
    label: ClassVar[str] = "Roll motion (counter-phase)"
    channel: ClassVar[str] = "pad_z"
    unit: ClassVar[str] = "mm"
    input_label: ClassVar[str] = "Counter-phase pad travel (right pad up +)"
    window: ClassVar[float] = 15.0

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return {"pad_L": static.pad[0] - value, "pad_R": static.pad[1] + value}


@dataclass(frozen=True)
class PadRoll(Roll):
    """The body is held, the pads move against each other as far as a body roll of the input would let them.

    Each pad moves half_track tan(angle).
    """

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        travel = static.half_track * np.tan(np.radians(value))
        return {"pad_L": static.pad[0] - travel, "pad_R": static.pad[1] + travel}


ROLL_TECHNIQUES: dict[str, LoadCase] = {
    "body": Roll(amplitude=4.0, steps=24),
    "counter_phase": CounterPhaseRoll(amplitude=60.0, steps=24),
}

load_case(ROLL_TECHNIQUES["body"])
