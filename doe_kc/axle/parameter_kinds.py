"""What each design parameter is, declared once: quantity, unit, bounds, step, scatter and sign."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from doe_kc.axle.model import BUSHING_AXES, BUSHINGS, EXTRA_HARDPOINTS, HARDPOINTS
from doe_kc.axle.sliders import BACKBONE_YIELDS
from doe_kc.ground.errors import InputError

Group = Literal["HARDPOINTS", "BUSHINGS", "OTHER"]
Quantity = Literal[
    "coordinate", "stiffness", "rate", "radius", "flexibility", "clearance", "angle", "height", "value"
]
"""What a parameter measures: a stiffness is the factor of a bushing; "value" is one that is not declared."""
Bounds = Literal["offset", "factor", "absolute"]
COORDINATES = ("x", "y", "z")
SIDE_PREFIXES = {"left": "L", "right": "R"}

PRODUCTION_SD: Mapping[Quantity, float] = {"coordinate": 1.0, "angle": 0.1}
"""mm, deg: one standard deviation between cars of one design."""
PRODUCTION_SHARE: Mapping[Quantity, float] = {
    "stiffness": 0.2,
    "rate": 0.03,
    "radius": 0.03,
    "flexibility": 0.03,
}
"""The same as a share of the value. Clearances and ride height are in neither: the search for the rig's
set-up treats them by itself."""


@dataclass(frozen=True)
class ParameterKind:
    """span: bounds as (down, up): offsets from the nominal value, its factors, or absolute. step: of a
    one-at-a-time change, a share of the nominal value where the bounds are factors. switch: field of the
    topology that is set while the value of either side is above zero, empty for most.
    """

    label: str
    group: Group
    quantity: Quantity
    unit: str
    span: tuple[float, float]
    step: float
    bounds: Bounds = "offset"
    switch: str = ""

    @property
    def relative(self) -> bool:
        """Whether equal steps are equal ratios."""
        return self.bounds == "factor"


def _kinds() -> dict[str, ParameterKind]:
    out: dict[str, ParameterKind] = {}
    for name, label in HARDPOINTS.items():
        for axis in "xyz":
            out[f"{name}.{axis}"] = point_kind(label, axis)
    for name, label in BUSHINGS.items():
        for axis in BUSHING_AXES:
            out[f"{name}.{axis}"] = bushing_kind(label, axis)
    return {**out, **OTHER_KINDS}


def _other_kinds() -> dict[str, ParameterKind]:
    return {
        "scb.Tz": _bush("Steering column bush, Tz"),
        "strut.flexibility": ParameterKind(
            "Strut flexibility ratio",
            "OTHER",
            "flexibility",
            "-",
            (0.0, 2.0),
            0.1,
            "absolute",
            "strut_bending",
        ),
        "bump_stop.clearance": _other("Bump stop clearance", "clearance", "mm", 10.0, 1.0),
        "rebound_stop.clearance": _other("Rebound stop clearance", "clearance", "mm", 10.0, 1.0),
        "spring.rate": _size("Spring rate", "rate", "N/mm", (0.8, 1.25)),
        "arb.radius": _size("Anti-roll bar outer radius", "radius", "mm", (0.8, 1.25)),
        "steer_arm.radius": _size("Steer arm outer radius", "radius", "mm", (0.7, 1.3)),
        "tyre.rate": _size("Tyre vertical stiffness", "rate", "N/mm", (0.8, 1.25)),
        "static.toe": _other("Static toe", "angle", "deg", 0.3, 0.1),
        "static.camber": _other("Static camber", "angle", "deg", 0.5, 0.1),
        "ride_height": _other("Ride height offset (pads up +)", "height", "mm", 10.0, 1.0),
    }


def point_kind(label: str, axis: str) -> ParameterKind:
    """Of a hardpoint's coordinate x, y or z."""
    return ParameterKind(f"{label}, {axis}", "HARDPOINTS", "coordinate", "mm", (-3.0, 3.0), 1.0)


def bushing_kind(label: str, axis: str) -> ParameterKind:
    """Of a bushing's stiffness along or about an axis, Fx to Tz."""
    what = "stiffness" if axis.startswith("F") else "rotational stiffness"
    return _bush(f"{label} bush, {what} {axis[1]}")


def _bush(label: str) -> ParameterKind:
    return ParameterKind(label, "BUSHINGS", "stiffness", "-", (0.5, 2.0), 0.1, "factor")


def _size(label: str, quantity: Quantity, unit: str, span: tuple[float, float]) -> ParameterKind:
    return ParameterKind(label, "OTHER", quantity, unit, span, 0.1, "factor")


def _other(label: str, quantity: Quantity, unit: str, either: float, step: float) -> ParameterKind:
    return ParameterKind(label, "OTHER", quantity, unit, (-either, either), step)


OTHER_KINDS: Mapping[str, ParameterKind] = _other_kinds()
"""Of parameters that are neither hardpoints nor bushings, in the order in which they are listed."""
KINDS: Mapping[str, ParameterKind] = _kinds()
SWITCHES: Mapping[str, str] = {path: kind.switch for path, kind in KINDS.items() if kind.switch}
"""Path -> field of the topology."""
PATHS = 4096
"""Names whose kind is remembered: a search asks for the same hundred thousands of times."""


@lru_cache(maxsize=PATHS)
def side_prefix(path: str) -> str:
    """`left.`, `right.` or nothing."""
    head = path.split(".")[0]
    return f"{head}." if head in SIDE_PREFIXES else ""


def kind_of(path: str) -> ParameterKind | None:
    """The declaration of a path, with or without a side; None for a value that no axle type has as a design
    parameter.

    Points and bushings that KINDS does not hold are an axle type's own, declared by the form of their path.
    """
    name = path.removeprefix(side_prefix(path))
    head, _, rest = name.partition(".")
    if name in KINDS:
        return KINDS[name]
    if rest in COORDINATES:
        return point_kind(EXTRA_HARDPOINTS.get(head, head), rest)
    return bushing_kind(head, rest) if rest in BUSHING_AXES else None


@lru_cache(maxsize=PATHS)
def quantity_of(path: str) -> Quantity:
    """What a path measures; of one that is not declared by its last name."""
    kind = kind_of(path)
    if kind is not None:
        return kind.quantity
    rest = path.removeprefix(side_prefix(path)).partition(".")[2]
    if rest in COORDINATES:
        return "coordinate"
    if rest.endswith("clearance"):
        return "clearance"
    return "radius" if rest == "radius" else "value"


POSITIVE_PARAMETERS = {
    *("stiffness", "rate", "lat_rate", "long_rate", "factor", "column"),
    *("kx", "ky", "kz", "krx", "kry", "krz"),
    *("radius", "nominal_radius", "rack_mm_per_rev", "static_load", "force", "presliding"),
    *("gap", "contact", "reference", "loaded_factor", "spread", "exponent"),
    *(f"share{i}" for i in range(len(BACKBONE_YIELDS))),
}
NOT_BELOW_ZERO = {
    *(path for path, kind in KINDS.items() if kind.quantity == "flexibility"),
    *("arb.rate", "damper.gas_force", "tie_rod.flexibility", "arb.link_flexibility", "power_assist.gain"),
}


@lru_cache(maxsize=PATHS)
def not_below_zero(name: str) -> bool:
    """Whether a value of that name may be zero but no less."""
    return name in NOT_BELOW_ZERO or ".cubic." in name


@lru_cache(maxsize=PATHS)
def must_be_positive(name: str) -> bool:
    """Whether a value of that name is one of size: a stiffness, load or radius."""
    rest = name.partition(".")[2]
    if rest in BUSHING_AXES or rest.startswith(("stiffness.", "rubber.")):
        return True
    if rest in COORDINATES or not_below_zero(name):
        return False
    return name in {"hub.camber", "hub.toe", "strut.bending", "strut.torsion"} or rest in POSITIVE_PARAMETERS


@lru_cache(maxsize=PATHS)
def is_lateral(name: str) -> bool:
    """Whether the right side has the opposite sign: y of a point."""
    return name.partition(".")[2] == "y"


def check_value(path: str, value: float, source: str) -> None:
    """InputError for a value that no axle can have."""
    if not math.isfinite(value):
        raise InputError(f"{source}: {path} = {value}, expected a finite number.")
    name = path.removeprefix(side_prefix(path))
    if value < 0 and not_below_zero(name):
        raise InputError(f"{source}: {path} = {value:g}, expected a number >= 0.")
    if value <= 0 and must_be_positive(name):
        raise InputError(
            f"{source}: {path} = {value:g}, expected a number > 0; "
            "a zero or negative stiffness, load or radius has no equilibrium."
        )
