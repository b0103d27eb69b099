"""The axle file: what users write, checked key by key."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from doe_kc.axle.force_curve import STEEPEST_CURVE
from doe_kc.axle.model import BUSHING_AXES
from doe_kc.axle_types import DEFAULT_TYPE
from doe_kc.ground.fields import Finite, NotNegative, Pair, Point, Positive, Strict


class Units(Strict):
    length: Literal["mm"]
    force: Literal["N"]
    angle: Literal["deg"]
    stiffness: Literal["N/mm"]
    rotational_stiffness: Literal["Nm/deg"]


class Bushing(Strict):
    """stiffness: N/mm and Nm/deg per axis; factor: 1 by default; table: axis -> [[d, F], ...]."""

    stiffness: dict[str, Positive]
    factor: dict[str, Positive] = Field(default_factory=dict)
    cubic: dict[str, NotNegative] = Field(default_factory=dict)
    preload: dict[str, Finite] = Field(default_factory=dict)
    table: dict[str, list[Pair]] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _axes(self) -> Bushing:
        for key, axes in (
            ("stiffness", BUSHING_AXES),
            ("factor", BUSHING_AXES),
            ("cubic", BUSHING_AXES[:3]),
            ("preload", BUSHING_AXES[:3]),
            ("table", BUSHING_AXES),
        ):
            unknown = set(getattr(self, key)) - set(axes)
            if unknown:
                raise ValueError(f"{key} has no axis {min(unknown)!r}; the axes are {', '.join(axes)}")
        missing = set(BUSHING_AXES) - set(self.stiffness) - set(self.table)
        if missing:
            raise ValueError(f"stiffness of axis {min(missing)} is missing")
        for axis, points in self.table.items():
            check_table(points, f"table.{axis}", through_zero=True)
        return self


def check_table(points: list[list[float]], name: str, *, through_zero: bool = False) -> None:
    """ValueError unless the points rise strictly in deflection and never fall in force."""
    if len(points) < 2:
        raise ValueError(f"{name} needs at least two points [deflection, force]")
    for row, (before, after) in enumerate(pairwise(points), start=2):
        if after[0] <= before[0]:
            raise ValueError(
                f"{name} is not monotone: point {row} has deflection {after[0]:g} after {before[0]:g}; "
                "deflections must rise"
            )
        if after[1] < before[1]:
            raise ValueError(
                f"{name} is not monotone: point {row} has force {after[1]:g} after {before[1]:g}; "
                "a bushing or stop that softens to a falling force has no unique equilibrium"
            )
        if not (after[1] - before[1]) / (after[0] - before[0]) <= STEEPEST_CURVE:
            raise ValueError(
                f"{name} is steeper than {STEEPEST_CURVE:g} N/mm or Nm/deg between deflection {before[0]:g} "
                f"and {after[0]:g}; no part is: correct point {row}"
            )
    if through_zero and not points[0][0] < 0 < points[-1][0]:
        raise ValueError(f"{name} must span zero deflection, from compression to extension")


class OrientedBushing(Bushing):
    """x, y: local axes in the design position, left side, chassis components; by default the type's."""

    x: Point | None = None
    y: Point | None = None


class Stop(Strict):
    clearance: Finite
    factor: Positive = 1.0
    curve: list[Pair]

    @model_validator(mode="after")
    def _curve(self) -> Stop:
        check_table(self.curve, "curve")
        if self.curve[0] != [0.0, 0.0]:
            raise ValueError("curve must start at [0, 0], the touch of the stop")
        return self


class Static(Strict):
    toe: Finite
    camber: Annotated[float, Field(gt=-45, lt=45, allow_inf_nan=False)]


class TyreTable(Strict):
    rate: Positive
    static_load: Positive


class Spring(Strict):
    rate: Positive


class Damper(Strict):
    gas_force: NotNegative = 0.0


class AntiRollBarTable(Strict):
    rate: NotNegative
    radius: Positive = 11.5
    nominal_radius: Positive = 11.5


class SteeringTable(Strict):
    column: Positive
    rack_mm_per_rev: Positive


class ColumnBushing(Strict):
    Tz: Positive = 1.0


class SteerArmTable(Strict):
    radius: Positive = 14.0
    flexible: bool = False


class StrutTable(Strict):
    flexibility: NotNegative = 0.0


class Sweep(Strict):
    amplitude: Positive | None = None
    steps: Annotated[int, Field(ge=2, le=2000)] | None = None
    control: Literal["pad", "wheel"] | None = None
    technique: Literal["body", "counter_phase"] | None = None
    offset: Finite | None = None
    conditioning: Annotated[int, Field(ge=0, le=10)] | None = None


class AxleFile(Strict):
    """The whole file. `schema` names the format and its version. Springs are tables of their own, named as in
    the type: `[spring]`. follow: None = the type's."""

    schema_: Literal["doe_kc.axle/1"] = Field(alias="schema")
    type: str = DEFAULT_TYPE
    name: str
    units: Units
    hardpoints: dict[str, Point]
    follow: dict[str, str] | None = None
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
