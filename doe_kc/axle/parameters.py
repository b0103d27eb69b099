"""Design parameters of an axle: paths such as `LLF.x`, `llr.Fx`, `spring.rate`, `right.LLR.y`.

A path holds an absolute value: hardpoints in mm in the chassis frame (left side; `right.` for the right
one), stiffness factors with nominal 1, the rest in its unit. A plain path moves both sides alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

from doe_kc.axle.model import (
    BUSHING_AXES,
    BUSHINGS,
    EXTRA_HARDPOINTS,
    HARDPOINTS,
    Axle,
)
from doe_kc.ground.errors import InputError, nearest

Group = Literal["HARDPOINTS", "BUSHINGS", "OTHER"]
SIDE_PREFIXES = {"left": "L", "right": "R"}


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """A design variable of one axle.

    nominal, lower, upper: absolute, in `unit` ("-" for factors). step: one-at-a-time change, absolute.
    active: False when the axle's model does not contain it (for example the radius of a rigid arm).
    """

    path: str
    label: str
    group: Group
    unit: str
    nominal: float
    lower: float
    upper: float
    step: float
    active: bool


@dataclass(frozen=True)
class _Kind:
    """span: bounds as (down, up), absolute or, when `relative`, as factors of the nominal value."""

    label: str
    group: Group
    unit: str
    span: tuple[float, float]
    step: float
    relative: bool = False


def _kinds() -> dict[str, _Kind]:
    out: dict[str, _Kind] = {}
    for name, label in HARDPOINTS.items():
        for axis in "xyz":
            out[f"{name}.{axis}"] = _Kind(f"{label}, {axis}", "HARDPOINTS", "mm", (-3.0, 3.0), 1.0)
    for name, label in BUSHINGS.items():
        for axis in BUSHING_AXES:
            what = "stiffness" if axis.startswith("F") else "rotational stiffness"
            out[f"{name}.{axis}"] = _Kind(
                f"{label} bush, {what} {axis[1]}", "BUSHINGS", "-", (0.5, 2.0), 0.1, relative=True
            )
    out["scb.Tz"] = _Kind("Steering column bush, Tz", "BUSHINGS", "-", (0.5, 2.0), 0.1, relative=True)
    out |= {
        "strut.flexibility": _Kind("Strut flexibility ratio", "OTHER", "-", (0.0, 2.0), 0.1),
        "bump_stop.clearance": _Kind("Bump stop clearance", "OTHER", "mm", (-10.0, 10.0), 1.0),
        "rebound_stop.clearance": _Kind("Rebound stop clearance", "OTHER", "mm", (-10.0, 10.0), 1.0),
        "spring.rate": _Kind("Spring rate", "OTHER", "N/mm", (0.8, 1.25), 0.1, relative=True),
        "arb.radius": _Kind("Anti-roll bar outer radius", "OTHER", "mm", (0.8, 1.25), 0.1, relative=True),
        "steer_arm.radius": _Kind("Steer arm outer radius", "OTHER", "mm", (0.7, 1.3), 0.1, relative=True),
        "tyre.rate": _Kind("Tyre vertical stiffness", "OTHER", "N/mm", (0.8, 1.25), 0.1, relative=True),
        "static.toe": _Kind("Static toe", "OTHER", "deg", (-0.3, 0.3), 0.1),
        "static.camber": _Kind("Static camber", "OTHER", "deg", (-0.5, 0.5), 0.1),
        "ride_height": _Kind("Ride height offset (pads up +)", "OTHER", "mm", (-10.0, 10.0), 1.0),
    }
    return out


KINDS: Mapping[str, _Kind] = _kinds()
POSITIVE_PARAMETERS = {
    *("stiffness", "rate", "lat_rate", "long_rate", "factor", "column"),
    *("kx", "ky", "kz", "krx", "kry", "krz"),
    *("radius", "nominal_radius", "rack_mm_per_rev", "static_load", "force", "presliding"),
    *("gap", "contact", "reference"),
}

PATHS = 4096
"""Names whose kind is remembered: a search asks for the same hundred thousands of times."""
NOT_BELOW_ZERO = {
    *("strut.flexibility", "arb.rate", "damper.gas_force"),
    *("tie_rod.flexibility", "arb.link_flexibility", "power_assist.gain"),
}


def design_parameters(axle: Axle) -> list[Parameter]:
    """Every design variable of Table 1 and Appendix A, in their order; followers only when freed."""
    return [
        _parameter(axle, path, kind) for path, kind in KINDS.items() if path.split(".")[0] not in axle.follow
    ]


def _parameter(axle: Axle, path: str, kind: _Kind) -> Parameter:
    nominal = parameter_value(axle, path)
    if kind.relative:
        lower, upper = (nominal * s for s in kind.span)
        step = abs(nominal) * kind.step
    else:
        lower, upper, step = nominal + kind.span[0], nominal + kind.span[1], kind.step
    if path == "strut.flexibility":
        lower, upper = kind.span
    return Parameter(
        path=path,
        label=kind.label,
        group=kind.group,
        unit=kind.unit,
        nominal=nominal,
        lower=lower,
        upper=upper,
        step=step,
        active=is_active(axle, path),
    )


def is_active(axle: Axle, path: str) -> bool:
    """Whether the axle's equations contain the parameter."""
    if path in {"strut.bending", "strut.torsion"}:
        return axle.topology.strut_bending
    if path.startswith("steer_arm.") or path.split(".")[0] == "SAH":
        return axle.topology.steer_arm
    return True


def settable_paths(axle: Axle) -> list[str]:
    """Every path that `with_values` takes on this axle, without the side prefixes."""
    return sorted({name.split("@")[0] for name in axle.values if ".table." not in name})


def parameter_value(axle: Axle, path: str, *, source: str = "parameter") -> float:
    """Absolute value of a path; of the left side when no side is named."""
    name, side = _split(axle, path, source)
    return _to_chassis(name, side, axle.values[_internal(axle, name, side or "L")])


def with_values(axle: Axle, values: Mapping[str, float], *, source: str = "parameter") -> Axle:
    """Copy of the axle with paths set to absolute values.

    Hardpoints that follow a moved one move along unless `values` sets them too. On an asymmetric axle a
    plain path keeps the difference of the sides (positions) or their ratio (stiffnesses, factors).
    Raises InputError for an unknown path (with the nearest name), a value that is not finite, or a
    stiffness, factor or radius that is not positive.
    """
    result: dict[str, float] = {}
    ranks: dict[str, int] = {}
    for path, value in values.items():
        check_value(path, value, source)
        if value == parameter_value(axle, path, source=source) and not _overrides(axle, path):
            continue
        for internal, change in _moves(axle, path, value, source):
            rank = _rank(path, internal)
            if rank > ranks.get(internal, -1):
                result[internal], ranks[internal] = axle.values[internal] + change, rank
    return _with_matching_topology(axle.changed(result))


def _with_matching_topology(axle: Axle) -> Axle:
    """A strut bends once its flexibility is above zero, and is rigid at zero."""
    bends = max(axle.values["strut.flexibility@L"], axle.values["strut.flexibility@R"]) > 0
    if bends == axle.topology.strut_bending:
        return axle
    return replace(axle, topology=replace(axle.topology, strut_bending=bends))


def _overrides(axle: Axle, path: str) -> bool:
    """Whether setting the path to the value it has still keeps it from moving with another."""
    return bool(_prefix(path)) or path.split(".")[0] in axle.follow


@lru_cache(maxsize=PATHS)
def _prefix(path: str) -> str:
    head = path.split(".")[0]
    return f"{head}." if head in SIDE_PREFIXES else ""


@lru_cache(maxsize=PATHS)
def _rank(path: str, internal: str) -> int:
    """Which path decides a value that several move: one set itself before one that follows, and of either
    kind one that names its side before one that moves both."""
    own = path.removeprefix(_prefix(path)) == internal.split("@")[0]
    return 2 * own + bool(_prefix(path))


def internal_gradient(axle: Axle, path: str, *, source: str = "parameter") -> dict[str, float]:
    """d(internal value) / d(path), followers included: what a unit change of the path changes."""
    unit = parameter_value(axle, path, source=source) + 1.0
    return dict(_moves(axle, path, unit, source))


def _moves(axle: Axle, path: str, value: float, source: str) -> Iterator[tuple[str, float]]:
    name, side = _split(axle, path, source)
    change = _to_left(name, side, value) - axle.values[_internal(axle, name, side or "L")]
    reference = axle.values[_internal(axle, name, side or "L")]
    for each in (side,) if side else ("L", "R"):
        internal = _internal(axle, name, each)
        scales = _is_ratio(name) and reference != 0
        yield internal, change * (axle.values[internal] / reference if scales else 1.0)
        if "@" not in internal:
            return
    point, _, axis = name.partition(".")
    for follower, leader in axle.follow.items():
        if leader == point and axis in "xyz":
            for each in (side,) if side else ("L", "R"):
                yield f"{follower}.{axis}@{each}", change


@lru_cache(maxsize=PATHS)
def _not_below_zero(name: str) -> bool:
    return name in NOT_BELOW_ZERO or ".cubic." in name


def check_value(path: str, value: float, source: str) -> None:
    """InputError for a value that no axle can have."""
    if not math.isfinite(value):
        raise InputError(f"{source}: {path} = {value}, expected a finite number.")
    name = path.removeprefix(_prefix(path))
    if value < 0 and _not_below_zero(name):
        raise InputError(f"{source}: {path} = {value:g}, expected a number >= 0.")
    if value <= 0 and _must_be_positive(name):
        raise InputError(
            f"{source}: {path} = {value:g}, expected a number > 0; "
            "a zero or negative stiffness, load or radius has no equilibrium."
        )


@lru_cache(maxsize=PATHS)
def _must_be_positive(name: str) -> bool:
    head, _, rest = name.partition(".")
    if head in BUSHINGS:
        return rest in BUSHING_AXES or rest.startswith("stiffness.")
    if head in HARDPOINTS or head in EXTRA_HARDPOINTS or _not_below_zero(name):
        return False
    return (
        name in {"scb.Tz", "hub.camber", "hub.toe", "strut.bending", "strut.torsion"}
        or rest in POSITIVE_PARAMETERS
    )


def _is_ratio(name: str) -> bool:
    return _must_be_positive(name)


def _split(axle: Axle, path: str, source: str) -> tuple[str, str | None]:
    head, _, rest = path.partition(".")
    side = SIDE_PREFIXES.get(head)
    name = rest if side else path
    internal = "@" in name or ".table." in name
    if not internal and (f"{name}@L" in axle.values or (name in axle.values and side is None)):
        return name, side
    known = settable_paths(axle)
    if name in known:
        raise InputError(f"{source}: {path}: {name} belongs to the whole axle; leave out {head!r}.")
    raise InputError(
        f"{source}: unknown parameter {path!r}; expected a path such as LLF.x, llr.Fx or spring.rate."
        f"{nearest(name, known)}"
    )


def _internal(axle: Axle, name: str, side: str) -> str:
    return f"{name}@{side}" if f"{name}@{side}" in axle.values else name


@lru_cache(maxsize=PATHS)
def _is_lateral(name: str) -> bool:
    point, _, axis = name.partition(".")
    return axis == "y" and (point in HARDPOINTS or point in EXTRA_HARDPOINTS)


def _to_chassis(name: str, side: str | None, value: float) -> float:
    return -value if side == "R" and _is_lateral(name) else value


_to_left = _to_chassis
