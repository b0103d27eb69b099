"""The type file: what users write, checked key by key."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from doe_kc.axle.structure import KinematicJoint
from doe_kc.ground.fields import Point, Strict


class BushingTable(Strict):
    """x, y: default axes in the design position, left side, chassis components; an axle file may give others.

    line: points along which z lies instead. joint: what stands in for it in pure kinematics.
    """

    label: str = ""
    inner: str
    outer: str
    at: str
    x: Point | None = None
    y: Point | None = None
    line: list[str] | None = None
    joint: KinematicJoint = "ball"
    single: bool = False

    @model_validator(mode="after")
    def _axes(self) -> BushingTable:
        if self.line is not None and (self.x is not None or self.y is not None):
            raise ValueError("line and x, y both say where the axes lie; leave one out")
        if (self.x is None) != (self.y is None):
            raise ValueError("x and y belong together; give both or none")
        if self.line is not None and len(self.line) != 2:
            raise ValueError("line needs two points, from and to")
        return self


class BallTable(Strict):
    label: str = ""
    a: str
    b: str
    at: str
    single: bool = False
    seat: str = ""


class LineTable(Strict):
    label: str = ""
    a: str
    at_a: str
    b: str
    at_b: str
    single: bool = False


class RackTable(Strict):
    body: str
    carrier: str
    at: str
    rods: list[str]


class BarTable(Strict):
    body: str
    at: str


class KingpinTable(Strict):
    lower: str
    lower_body: str
    upper: str
    upper_body: str


class SplitTable(Strict):
    body: str
    centre: list[str]


class ClampTable(Strict):
    body: str
    carrier: str
    at: str
    line: Annotated[list[str], Field(min_length=2, max_length=2)]


class BeamTable(Strict):
    body: str
    carrier: str
    root: str
    at: str


class AxleTypeFile(Strict):
    """The whole file. `schema` names the format and its version."""

    schema_: Literal["doe_kc.axle_type/1"] = Field(alias="schema")
    type: str
    label: str
    carrier: str
    bodies: dict[str, Literal["side", "single"]]
    points: dict[str, str]
    single_points: dict[str, str] = Field(default_factory=dict)
    bushings: dict[str, BushingTable] = Field(default_factory=dict)
    balls: dict[str, BallTable] = Field(default_factory=dict)
    rods: dict[str, LineTable] = Field(default_factory=dict)
    cylindricals: dict[str, LineTable] = Field(default_factory=dict)
    springs: dict[str, LineTable]
    damper: LineTable | None = None
    rack: RackTable | None = None
    arb: BarTable | None = None
    kingpin: KingpinTable | None = None
    subframe: SplitTable | None = None
    strut: ClampTable | None = None
    steer_arm: BeamTable | None = None
    fixed_points: list[str] = Field(default_factory=list)
    follow: dict[str, str] = Field(default_factory=dict)
    lines: dict[str, list[Annotated[list[str], Field(min_length=2, max_length=2)]]] = Field(
        default_factory=dict
    )
