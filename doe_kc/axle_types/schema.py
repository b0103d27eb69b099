"""The type file: what users write, checked key by key."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from doe_kc.ground.fields import Point, Strict


class BushingTable(Strict):
    """x, y: default axes in the design position, left side, chassis components; an axle file may give others.

    line: points along which z lies instead.
    """

    label: str = ""
    inner: str
    outer: str
    at: str
    x: Point | None = None
    y: Point | None = None
    line: list[str] | None = None
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
