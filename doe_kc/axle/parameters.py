"""Design parameters of an axle: paths such as `LLF.x`, `llr.Fx`, `spring.rate`, `right.LLR.y`.

A path holds an absolute value: hardpoints in mm in the chassis frame (left side; `right.` for the right
one), stiffness factors with nominal 1, the rest in its unit. A plain path moves both sides alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import (
    PATHS,
    PRODUCTION_SD,
    PRODUCTION_SHARE,
    SIDE_PREFIXES,
    SWITCHES,
    Group,
    ParameterKind,
    Quantity,
    is_lateral,
    kind_of,
    must_be_positive,
    not_below_zero,
    quantity_of,
    side_prefix,
)
from doe_kc.axle.structure_parameters import structure_kinds
from doe_kc.axle.topology import Topology
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray


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

    @property
    def quantity(self) -> Quantity:
        """What it measures; of a path that is not declared, by its group or last name."""
        if self.group == "HARDPOINTS" and kind_of(self.path) is None:
            return "coordinate"
        return quantity_of(self.path)

    @property
    def one_sided(self) -> bool:
        """Whether it is at its lower limit of zero, and can only be raised."""
        return self.lower == 0.0 and self.nominal < self.step

    @property
    def mirrored(self) -> bool:
        """Whether the right side has the opposite sign in the chassis frame."""
        return is_lateral(self.path.removeprefix(side_prefix(self.path)))

    @property
    def in_model(self) -> bool:
        """Whether the axle's model contains it: not where a zero value switches it off."""
        return self.active and not (self.path in SWITCHES and self.nominal == 0.0)

    @property
    def production_sd(self) -> float:
        """One standard deviation between cars of one design, in its unit; 0 for one that does not scatter."""
        if not self.active:
            return 0.0
        share = PRODUCTION_SHARE.get(self.quantity, 0.0)
        return PRODUCTION_SD.get(self.quantity, share * abs(self.nominal))


def design_parameters(axle: Axle) -> list[Parameter]:
    """Every design variable of Table 1 and Appendix A, in their order; followers only when freed."""
    kinds = structure_kinds(axle.topology.structure, axle.labels)
    return [
        _parameter(axle, path, kind) for path, kind in kinds.items() if path.split(".")[0] not in axle.follow
    ]


def _parameter(axle: Axle, path: str, kind: ParameterKind) -> Parameter:
    nominal = parameter_value(axle, path)
    if kind.relative:
        lower, upper = (nominal * s for s in kind.span)
        step = abs(nominal) * kind.step
    else:
        lower, upper, step = nominal + kind.span[0], nominal + kind.span[1], kind.step
    if kind.bounds == "absolute":
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
    if path.startswith("arb.") and path != "arb.rate":
        return axle.values["arb.rate"] > 0
    return True


def settable_paths(axle: Axle) -> list[str]:
    """Every path that `with_values` takes on this axle, without the side prefixes."""
    return sorted({n.split("@")[0] for n in axle.values if ".table." not in n})


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
    return ParameterMap(axle, tuple(values), source=source).axle(tuple(values.values()))


class ParameterMap:
    """Axles whose `paths` have other values: what `with_values` does, the paths read once for many designs.

    Raises InputError for an unknown path.
    """

    def __init__(self, axle: Axle, paths: Sequence[str], *, source: str = "parameter") -> None:
        self._axle, self._source = axle, source
        self._paths = [_path_effect(axle, path, source) for path in paths]

    def axle(self, values: Sequence[float]) -> Axle:
        """The axle with the values of the paths, in their order; InputError as `with_values`."""
        result: dict[str, float] = {}
        ranks: dict[str, int] = {}
        known = self._axle.values
        for effect, value in zip(self._paths, values, strict=True):
            if not (math.isfinite(value) and value > effect.least):
                check_value(effect.path, value, self._source)
            if value == effect.value and not effect.overrides:
                continue
            change = effect.sign * value - effect.reference
            for internal, factor, rank in effect.moves:
                if rank > ranks.get(internal, -1):
                    result[internal], ranks[internal] = known[internal] + change * factor, rank
        return _with_matching_topology(self._axle.changed(result))

    def changes(self, values: FloatArray) -> dict[str, FloatArray]:
        """Internal values that differ between designs, or from the axle's: name -> (d,), what `axle` gives for
        each row of the values (d, paths), one column a path in their order. InputError as `axle`."""
        count = len(values)
        out: dict[str, FloatArray] = {}
        ranks: dict[str, FloatArray] = {}
        for effect, column in zip(self._paths, values.T, strict=True):
            for value in column[~(np.isfinite(column) & (column > effect.least))]:
                check_value(effect.path, float(value), self._source)
            sets = np.full(count, True) if effect.overrides else column != effect.value
            change = effect.sign * column - effect.reference
            for internal, factor, rank in effect.moves:
                before = ranks.setdefault(internal, np.full(count, -1.0))
                moves = sets & (rank > before)
                known = out.setdefault(internal, np.full(count, self._axle.values[internal]))
                known[moves] = (self._axle.values[internal] + change * factor)[moves]
                before[moves] = rank
        return out


@dataclass(frozen=True)
class _PathEffect:
    """What a path moves. value: it has; least: any larger is allowed, the others are looked at closely;
    reference: internal value that sign * value replaces; moves: internal name, factor on the change, rank."""

    path: str
    value: float
    least: float
    overrides: bool
    sign: float
    reference: float
    moves: tuple[tuple[str, float, int], ...]


def _path_effect(axle: Axle, path: str, source: str) -> _PathEffect:
    name, side = _split(axle, path, source)
    reference = axle.values[_internal(axle, name, side or "L")]
    positive = must_be_positive(name) or not_below_zero(name)
    moves = _moves(axle, name, side, reference)
    return _PathEffect(
        path=path,
        value=_to_chassis(name, side, reference),
        least=0.0 if positive else -math.inf,
        overrides=_overrides(axle, path),
        sign=_to_left(name, side, 1.0),
        reference=reference,
        moves=tuple((internal, factor, _rank(path, internal)) for internal, factor in moves),
    )


def _with_matching_topology(axle: Axle) -> Axle:
    """A strut bends once its flexibility is above zero, and is rigid at zero."""
    for path, flag in SWITCHES.items():
        if f"{path}@L" not in axle.values:
            continue
        there = max(axle.values[f"{path}@L"], axle.values[f"{path}@R"]) > 0
        if there != getattr(axle.topology, flag):
            change: dict[str, Any] = {flag: there}
            axle = replace(axle, topology=replace(axle.topology, **change))
    return axle


def switched_topology(axle: Axle, path: str) -> Topology:
    """The topology once the values that a path moves are above zero: for most paths the axle's own."""
    names = {name.split("@")[0] for name in internal_gradient(axle, path)}
    flags: dict[str, Any] = {flag: True for name, flag in SWITCHES.items() if name in names}
    return replace(axle.topology, **flags)


def topology_with(axle: Axle, values: Mapping[str, float]) -> Topology:
    """The topology of `with_values`, by the values alone that can switch it."""
    switching = {p: v for p, v in values.items() if p.removeprefix(side_prefix(p)) in SWITCHES}
    return with_values(axle, switching).topology if switching else axle.topology


def _overrides(axle: Axle, path: str) -> bool:
    """Whether setting the path to the value it has still keeps it from moving with another."""
    return bool(side_prefix(path)) or path.split(".")[0] in axle.follow


@lru_cache(maxsize=PATHS)
def _rank(path: str, internal: str) -> int:
    """Which path decides a value that several move: one set itself before one that follows, and of either
    kind one that names its side before one that moves both."""
    own = path.removeprefix(side_prefix(path)) == internal.split("@")[0]
    return 2 * own + bool(side_prefix(path))


def internal_gradient(axle: Axle, path: str, *, source: str = "parameter") -> dict[str, float]:
    """d(internal value) / d(path), followers included: what a unit change of the path changes."""
    effect = _path_effect(axle, path, source)
    return {internal: effect.sign * factor for internal, factor, _ in effect.moves}


def _moves(axle: Axle, name: str, side: str | None, reference: float) -> Iterator[tuple[str, float]]:
    """Internal values that a path moves, and by how much over the change of the one that it is read from."""
    known, sides = axle.values, (side,) if side else ("L", "R")
    scales = reference != 0 and must_be_positive(name)
    if f"{name}@{sides[0]}" not in known:
        yield name, 1.0
        return
    for each in sides:
        internal = f"{name}@{each}"
        yield internal, known[internal] / reference if scales else 1.0
    point, _, axis = name.partition(".")
    if axis not in "xyz":
        return
    for follower, leader in axle.follow.items():
        if leader == point:
            for each in sides:
                yield f"{follower}.{axis}@{each}", 1.0


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


def _to_chassis(name: str, side: str | None, value: float) -> float:
    return -value if side == "R" and is_lateral(name) else value


_to_left = _to_chassis
