"""Forces on both wheels with the pads held: drive, brake, and lateral in three ways."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases._base import Controls, Datum, LoadCase, held_pads, load_case


@dataclass(frozen=True)
class WheelForce(LoadCase):
    """A force in N on each wheel, pads at their static height. share: control -> its force per N of input."""

    unit: ClassVar[str] = "N"
    window: ClassVar[float] = 1000.0
    share: ClassVar[Mapping[str, float]]

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return held_pads(static) | {name: share * value for name, share in self.share.items()}


@dataclass(frozen=True)
class Brake(WheelForce):
    """At each contact point, wheel locked to the knuckle, + = rearwards."""

    id: ClassVar[str] = "brake"
    label: ClassVar[str] = "Brake force"
    channel: ClassVar[str] = "force_x"
    input_label: ClassVar[str] = "Brake force per wheel (rearwards +)"
    share: ClassVar[Mapping[str, float]] = {"brake_L": 1.0, "brake_R": 1.0}


@dataclass(frozen=True)
class Drive(WheelForce):
    """At each wheel centre, + = forwards."""

    id: ClassVar[str] = "drive"
    label: ClassVar[str] = "Drive force"
    channel: ClassVar[str] = "force_x"
    input_label: ClassVar[str] = "Drive force per wheel (forwards +)"
    share: ClassVar[Mapping[str, float]] = {"drive_L": 1.0, "drive_R": 1.0}


@dataclass(frozen=True)
class Lateral(WheelForce):
    """At each contact point, + = to the right on both wheels."""

    id: ClassVar[str] = "lateral"
    label: ClassVar[str] = "Lateral force"
    channel: ClassVar[str] = "force_y"
    input_label: ClassVar[str] = "Lateral force per wheel (both wheels to the right +)"
    share: ClassVar[Mapping[str, float]] = {"lateral_L": 1.0, "lateral_R": 1.0}


@dataclass(frozen=True)
class LateralOffset(WheelForce):
    """Behind each contact point, + = to the right on both wheels. offset: how far behind, mm."""

    offset: float = 30.0

    id: ClassVar[str] = "lateral_offset"
    label: ClassVar[str] = "Lateral force, 30 mm offset"
    channel: ClassVar[str] = "force_y"
    input_label: ClassVar[str] = Lateral.input_label
    share: ClassVar[Mapping[str, float]] = Lateral.share

    def controls(self, value: FloatArray, static: Datum) -> Controls:
        return super().controls(value, static) | {"lateral_offset": self.offset}


@dataclass(frozen=True)
class LateralOpposite(WheelForce):
    """At each contact point, + = inwards on both (to the right on the left wheel)."""

    id: ClassVar[str] = "lateral_opposite"
    label: ClassVar[str] = "Lateral force, opposite"
    channel: ClassVar[str] = "force_y"
    input_label: ClassVar[str] = "Lateral force per wheel (inwards +)"
    share: ClassVar[Mapping[str, float]] = {"lateral_L": 1.0, "lateral_R": -1.0}


for _case in (Brake, Drive, Lateral, LateralOffset, LateralOpposite):  # the order of LOAD_CASES
    load_case(_case(amplitude=2000.0, steps=20))
