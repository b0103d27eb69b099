"""The name map: which hardpoint, bushing, spring or parameter of a template is what on an axle type.

Names are the template author's choice, so the map is a TOML file that the user edits.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import Field

from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.fields import Finite, Strict
from doe_kc.ground.files import read_toml, validate

NAME_MAPS = Path(__file__).parent / "name_maps"
MAPPED_TYPES = tuple(sorted(path.stem for path in NAME_MAPS.glob("*.toml")))
"""Axle types with a name map of the package's own."""

RatioUnit = Literal["", "mm/deg", "mm/rad", "mm/rev", "rad/mm", "deg/mm"]
TorsionUnit = Literal["Nmm/deg", "Nm/deg", "Nmm/rad", "Nm/rad"]
PartOfBushing = Literal["outer", "inner"]


class FrameTable(Strict):
    """Axes of the files; inferred where left out. ground_z: height of the ground, mm, in the files' frame."""

    x: Literal["rearwards", "forwards"] | None = None
    y: Literal["right", "left"] | None = None
    z: Literal["up", "down"] | None = None
    ground_z: Finite | None = None


class BushingNames(Strict):
    """usage: names of the bushing, the first that is there counts. i_part: whether the I part of ADAMS is the
    outer (moved) or the inner part of the type. z: hardpoints along which local z lies where the file does
    not say. switch: parameter that holds the parts together when 0."""

    usage: list[str]
    i_part: PartOfBushing = "outer"
    z: list[str] = Field(default_factory=list, max_length=2)
    switch: str = ""


class SteeringNames(Strict):
    """gear: of pinion and rack. ratio_unit: of its REDUCTION_RATIO, which no file states. torsion_bar:
    bushing whose TZ is the column's stiffness. rack_mount: bushing of the housing, FY along the rack."""

    gear: list[str] = Field(default_factory=list)
    ratio_unit: RatioUnit = ""
    torsion_bar: list[str] = Field(default_factory=list)
    rack_mount: list[str] = Field(default_factory=list)


class BarNames(Strict):
    """torsion: parameter of the bar's torsional stiffness, in torsion_unit. axis: hardpoint on its axis.
    arm_end: hardpoint of the drop link's end on the bar."""

    torsion: list[str] = Field(default_factory=list)
    torsion_unit: TorsionUnit = "Nmm/deg"
    axis: list[str] = Field(default_factory=list)
    arm_end: list[str] = Field(default_factory=list)


class ParameterNames(Strict):
    """Names of rows of [PARAMETER]: toe and camber in deg, the tyre's stiffness in force per length."""

    toe: list[str] = Field(default=["toe_angle"])
    camber: list[str] = Field(default=["camber_angle"])
    tyre_rate: list[str] = Field(default=["tire_stiffness"])
    kinematic: list[str] = Field(default=["kinematic_flag"])


class NameMap(Strict):
    """The whole file. hardpoints: point of the type -> names, the first that is there counts.

    lower, upper: points of the type of which the second is higher. values: parameter path -> value, for what
    no file says, in the axle file's units; they win over what a file says.
    """

    schema_: Literal["doe_kc.adams_names/1"] = Field(alias="schema")
    type: str
    templates: list[str] = Field(default_factory=list)
    lower: str
    upper: str
    frame: FrameTable = FrameTable()
    hardpoints: dict[str, list[str]]
    bushings: dict[str, BushingNames]
    springs: dict[str, list[str]]
    dampers: list[str] = Field(default_factory=list)
    bump_stop: list[str] = Field(default_factory=list)
    rebound_stop: list[str] = Field(default_factory=list)
    hub: BushingNames | None = None
    steering: SteeringNames = SteeringNames()
    arb: BarNames = BarNames()
    parameters: ParameterNames = ParameterNames()
    values: dict[str, Finite] = Field(default_factory=dict)


def name_map_path(type_name: str, *, source: str = "--type") -> Path:
    """The package's own map of a type; InputError for a type that has none."""
    if type_name not in MAPPED_TYPES:
        raise InputError(
            f"{source} {type_name}: there is no name map for this type; known are {', '.join(MAPPED_TYPES)}. "
            f"Give one of your own by --map.{nearest(type_name, MAPPED_TYPES)}"
        )
    return NAME_MAPS / f"{type_name}.toml"


def read_name_map(path: Path) -> NameMap:
    """A name map; InputError naming file and key for anything wrong."""
    return validate(NameMap, read_toml(path), str(path))
