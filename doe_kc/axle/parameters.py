"""Design parameters of an axle: paths such as `LLF.x`, `llr.Fx`, `spring.rate`, `right.LLR.y`.

A path holds an absolute value: hardpoints in mm in the chassis frame (left side; `right.` for the right
one), stiffness factors with nominal 1, the rest in its unit. A plain path moves both sides alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import (
    PATHS,
    SIDE_PREFIXES,
    SWITCHES,
    check_value,
    is_lateral,
    must_be_positive,
    not_below_zero,
    side_prefix,
)
from doe_kc.axle.topology import Topology
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray

READINGS = 256
"""Lists of paths that are kept read, each for the names of one kind of axle."""


def settable_paths(axle: Axle) -> list[str]:
    """Every path that `with_values` takes on this axle, without the side prefixes."""
    return _settable(axle.values.keys())


def parameter_value(axle: Axle, path: str, *, source: str = "parameter") -> float:
    """Absolute value of a path; of the left side when no side is named."""
    known = axle.values.keys()
    name, side = _split(known, path, source)
    return _to_chassis(name, side, axle.values[_internal(known, name, side or "L")])


def with_values(axle: Axle, values: Mapping[str, float], *, source: str = "parameter") -> Axle:
    """Copy of the axle with paths set to absolute values.

    Hardpoints that follow a moved one move along unless `values` sets them too. On an asymmetric axle a
    plain path keeps the difference of the sides (positions) or their ratio (stiffnesses, factors).
    Raises InputError for an unknown path (with the nearest name), a value that is not finite, or a
    stiffness, factor or radius that is not positive.
    """
    return ParameterMap(axle, tuple(values), source=source).axle(tuple(values.values()))


def names_touched(axle: Axle, paths: Sequence[str], *, source: str = "parameter") -> frozenset[str]:
    """Internal values that `with_values` reads or moves for some paths; InputError for an unknown path."""
    return _names_touched(tuple(paths), tuple(axle.values), tuple(axle.follow.items()), source)


@lru_cache(maxsize=READINGS)
def _names_touched(
    paths: tuple[str, ...], names: tuple[str, ...], follow: tuple[tuple[str, str], ...], source: str
) -> frozenset[str]:
    readings = _readings(paths, names, follow, source)
    moved = {internal for reading in readings for internal, _, _ in reading.moves}
    switching = {f"{path}@{side}" for path in SWITCHES for side in "LR"}
    return frozenset({reading.reference for reading in readings} | moved | switching)


class ParameterMap:
    """Axles whose `paths` have other values: what `with_values` does, the paths read once for many designs.

    Raises InputError for an unknown path.
    """

    def __init__(self, axle: Axle, paths: Sequence[str], *, source: str = "parameter") -> None:
        self._axle, self._source = axle, source
        self._paths = _path_effects(axle, paths, source)

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
        """Internal values that differ between designs, or from the axle's: name -> (d,), as `axle` gives for
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


@dataclass(frozen=True)
class _PathReading:
    """What a path reads and moves on every axle of the same names, whatever their values.

    side: R where its values are mirrored. reference: internal name that it is read from. relative: moves are
    shares of what they move. moves: internal name, rank, whether it follows the change itself.
    """

    path: str
    name: str
    side: str | None
    reference: str
    least: float
    overrides: bool
    relative: bool
    moves: tuple[tuple[str, int, bool], ...]


def _path_effects(axle: Axle, paths: Sequence[str], source: str) -> list[_PathEffect]:
    readings = _readings(tuple(paths), tuple(axle.values), tuple(axle.follow.items()), source)
    return [_path_effect(reading, axle.values) for reading in readings]


def _path_effect(reading: _PathReading, values: Mapping[str, float]) -> _PathEffect:
    reference = values[reading.reference]
    relative = reading.relative and reference != 0
    return _PathEffect(
        path=reading.path,
        value=_to_chassis(reading.name, reading.side, reference),
        least=reading.least,
        overrides=reading.overrides,
        sign=_to_left(reading.name, reading.side, 1.0),
        reference=reference,
        moves=tuple(
            (internal, values[internal] / reference if relative and not follows else 1.0, rank)
            for internal, rank, follows in reading.moves
        ),
    )


@lru_cache(maxsize=READINGS)
def _readings(
    paths: tuple[str, ...], names: tuple[str, ...], follow: tuple[tuple[str, str], ...], source: str
) -> tuple[_PathReading, ...]:
    """names: of the axle's internal values. follow: of each hardpoint that follows, itself and its leader."""
    known, leaders = frozenset(names), dict(follow)
    return tuple(_reading(path, known, leaders, source) for path in paths)


def _reading(path: str, known: Set[str], follow: Mapping[str, str], source: str) -> _PathReading:
    name, side = _split(known, path, source)
    positive = must_be_positive(name)
    return _PathReading(
        path=path,
        name=name,
        side=side,
        reference=_internal(known, name, side or "L"),
        least=0.0 if positive or not_below_zero(name) else -math.inf,
        overrides=_overrides(follow, path),
        relative=positive,
        moves=tuple(
            (internal, _rank(path, internal), follows)
            for internal, follows in _moves(known, follow, name, side)
        ),
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
    return replace(axle.topology, **flags) if flags else axle.topology


def topology_with(axle: Axle, values: Mapping[str, float]) -> Topology:
    """The topology of `with_values`, by the values alone that can switch it."""
    switching = {path: values[path] for path in _switching_paths(tuple(values))}
    return with_values(axle, switching).topology if switching else axle.topology


@lru_cache(maxsize=64)
def _switching_paths(paths: tuple[str, ...]) -> tuple[str, ...]:
    """Those that can switch the topology."""
    return tuple(p for p in paths if p.removeprefix(side_prefix(p)) in SWITCHES)


def _overrides(follow: Mapping[str, str], path: str) -> bool:
    """Whether setting the path to the value it has still keeps it from moving with another."""
    return bool(side_prefix(path)) or path.split(".")[0] in follow


@lru_cache(maxsize=PATHS)
def _rank(path: str, internal: str) -> int:
    """Which path decides a value that several move: one set itself before one that follows, and of either
    kind one that names its side before one that moves both."""
    own = path.removeprefix(side_prefix(path)) == internal.split("@")[0]
    return 2 * own + bool(side_prefix(path))


def internal_gradient(axle: Axle, path: str, *, source: str = "parameter") -> dict[str, float]:
    """d(internal value) / d(path), followers included: what a unit change of the path changes."""
    (effect,) = _path_effects(axle, [path], source)
    return {internal: effect.sign * factor for internal, factor, _ in effect.moves}


def _moves(
    known: Set[str], follow: Mapping[str, str], name: str, side: str | None
) -> Iterator[tuple[str, bool]]:
    """Internal values that a path moves, and whether they are those of a point that follows."""
    sides = (side,) if side else ("L", "R")
    if f"{name}@{sides[0]}" not in known:
        yield name, True
        return
    for each in sides:
        yield f"{name}@{each}", False
    point, _, axis = name.partition(".")
    if axis not in "xyz":
        return
    for follower, leader in follow.items():
        if leader == point:
            for each in sides:
                yield f"{follower}.{axis}@{each}", True


def _split(known: Set[str], path: str, source: str) -> tuple[str, str | None]:
    head, _, rest = path.partition(".")
    side = SIDE_PREFIXES.get(head)
    name = rest if side else path
    internal = "@" in name or ".table." in name
    if not internal and (f"{name}@L" in known or (name in known and side is None)):
        return name, side
    settable = _settable(known)
    if name in settable:
        raise InputError(f"{source}: {path}: {name} belongs to the whole axle; leave out {head!r}.")
    raise InputError(
        f"{source}: unknown parameter {path!r}; expected a path such as LLF.x, llr.Fx or spring.rate."
        f"{nearest(name, settable)}"
    )


def _settable(known: Set[str]) -> list[str]:
    return sorted({n.split("@")[0] for n in known if ".table." not in n})


def _internal(known: Set[str], name: str, side: str) -> str:
    return f"{name}@{side}" if f"{name}@{side}" in known else name


def _to_chassis(name: str, side: str | None, value: float) -> float:
    return -value if side == "R" and is_lateral(name) else value


_to_left = _to_chassis
