"""The axle file of a type that is data: what users write, checked key by key."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from doe_kc.axle_file.schema import (
    AntiRollBarTable,
    Bushing,
    ColumnBushing,
    Damper,
    Spring,
    Static,
    SteerArmTable,
    SteeringTable,
    Stop,
    StrutTable,
    Sweep,
    TyreTable,
    Units,
)
from doe_kc.ground.fields import Finite, Point, Strict


class OrientedBushing(Bushing):
    """x, y: local axes in the design position, left side, chassis components; by default the type's."""

    x: Point | None = None
    y: Point | None = None


class TypedAxleFile(Strict):
    """The whole file. Springs are tables of their own, named as in the type: `[spring]`."""

    schema_: Literal["doe_kc.axle/1"] = Field(alias="schema")
    type: str
    name: str
    units: Units
    hardpoints: dict[str, Point]
    follow: dict[str, str] = Field(default_factory=dict)
    static: Static
    tyre: TyreTable
    springs: dict[str, Spring]
    damper: Damper = Damper()
    bump_stop: Stop | None = None
    rebound_stop: Stop | None = None
    arb: AntiRollBarTable | None = None
    steering: SteeringTable | None = None
    scb: ColumnBushing = ColumnBushing()
    bushings: dict[str, OrientedBushing]
    strut: StrutTable | None = None
    steer_arm: SteerArmTable | None = None
    ride_height: Finite = 0.0
    right: dict[str, Finite] = Field(default_factory=dict)
    effects: dict[str, dict[str, Any]] = Field(default_factory=dict)
    load_cases: dict[str, Sweep] = Field(default_factory=dict)
