"""The single errors that may explain a pattern of wrong slopes, and what the slopes were without each."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations

import numpy as np

from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.typing import FloatArray, IntArray
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES
from doe_kc.measurement.checks._base import channel_name
from doe_kc.measurement.checks.identity.slopes import SlopeTable, column, row

DEG_PER_RAD = 180.0 / math.pi
ANGLE_FACTORS: Mapping[float, str] = {1.0 / DEG_PER_RAD: "rad", 60.0: "arcmin", 1000.0 / DEG_PER_RAD: "mrad"}
TOE_FACTORS: Mapping[float, str] = {**ANGLE_FACTORS, 2.0: "the total of both wheels"}
LENGTH_FACTORS: Mapping[float, str] = {1e-3: "m", 0.1: "cm", 1.0 / 25.4: "in"}
LOAD_FACTORS: Mapping[float, str] = {1e-3: "kN", 1.0 / 9.80665: "kg", 1.0 / 4.4482216: "lbf", 0.1: "daN"}
"""Number in the unit per number in that of the package -> the unit."""
SAME_INPUT = (("lateral", "lateral_opposite", "lateral_offset"), ("drive", "brake"))
"""Load cases whose files have the same columns."""


@dataclass(frozen=True)
class ChannelFault:
    """One error. kind: of finding. cases, channel: where, as findings name it. price: added to its misfit,
    the more the more special it is. words: what is wrong. cure: how it is mended.

    slope, rest: factors that undo it, (8, 7, 2) and (8, 2). order: of exchanged channels, index of each place
    in the flattened slopes. source: (8,) row whose expectations hold. Each None where it changes nothing.
    unit: in which the channel is, empty for other kinds.
    """

    kind: str
    cases: tuple[str, ...]
    channel: str
    price: float
    words: str
    cure: str
    slope: FloatArray | None = None
    rest: FloatArray | None = None
    order: IntArray | None = None
    source: IntArray | None = None
    unit: str = ""


@dataclass(frozen=True)
class FaultSet:
    """All faults looked for in a test, stacked (h, ...) as in `ChannelFault`."""

    members: tuple[ChannelFault, ...]
    price: FloatArray
    slope: FloatArray
    rest: FloatArray
    order: IntArray
    source: IntArray

    def undone(self, table: SlopeTable) -> SlopeTable:
        """The slopes as they were without each of the errors, (h, ...)."""
        slope, noise = (
            a.reshape(-1)[self.order].reshape(self.slope.shape) for a in (table.slope, table.noise)
        )
        own = self.order.reshape(self.slope.shape)[:, :, column("tyre_load")]
        _, response, side = np.unravel_index(own, table.slope.shape)
        rest = np.where(response == column("tyre_load"), table.rest.reshape(-1)[2 * _ROWS + side], np.nan)
        return SlopeTable(slope * self.slope, rest * self.rest, noise * np.abs(self.slope))


_SHAPE = len(CASE_ORDER), len(RIG_RESPONSES), 2
_ROWS = np.arange(_SHAPE[0])[None, :, None]


@cache
def fault_set(cases: tuple[str, ...], *, counter_phase: bool) -> FaultSet:
    """Every error that is looked for in a test with records of `cases`."""
    members = tuple(channel_faults(cases, counter_phase=counter_phase))
    ones, places = np.ones(_SHAPE), np.arange(np.prod(_SHAPE))
    return FaultSet(
        members,
        np.array([h.price for h in members]),
        np.stack([ones if h.slope is None else h.slope for h in members]),
        np.stack([ones[:, 0] if h.rest is None else h.rest for h in members]),
        np.stack([places if h.order is None else h.order for h in members]),
        np.stack([_ROWS[0, :, 0] if h.source is None else h.source for h in members]),
    )


def channel_faults(cases: Sequence[str], *, counter_phase: bool = False) -> Iterator[ChannelFault]:
    """Every error that is looked for in a test with records of `cases`."""
    yield from _scaled_channels(cases)
    yield from _scaled_inputs(cases)
    yield from _axes(cases)
    yield from _exchanged_sides(cases)
    yield from _exchanged_columns(cases)
    yield from _exchanged_cases(cases, counter_phase)


def _places(cases: Sequence[str]) -> Iterator[tuple[tuple[str, ...], float]]:
    """All load cases at once, then each alone, with what that costs."""
    yield tuple(cases), 2.0
    if len(cases) > 1:
        for case in cases:
            yield (case,), 4.0


def _where(cases: Sequence[str], everywhere: Sequence[str]) -> str:
    return "in every load case" if len(cases) == len(everywhere) else f"in {', '.join(cases)}"


def _factors(response: str) -> Mapping[float, str]:
    if response in ("tyre_load", "toe"):
        return LOAD_FACTORS if response == "tyre_load" else TOE_FACTORS
    return LENGTH_FACTORS if response.startswith("wc") else ANGLE_FACTORS


def _scaled_channels(cases: Sequence[str]) -> Iterator[ChannelFault]:
    groups: list[tuple[str, ...]] = [(r,) for r in RIG_RESPONSES]
    groups += [("toe", "camber", "spin"), ("wc_x", "wc_y"), ("wc_x", "wc_y", "wc_z")]
    for some, price in _places(cases):
        for group in groups:
            for sides in ((0, 1), (0,), (1,)):
                if len(group) > 1 and len(sides) == 1:
                    continue
                special = price + (0.0 if len(sides) == 2 else 1.0) + (1.0 if len(group) > 1 else 0.0)
                for factor, unit in {-1.0: "", **_factors(group[-1])}.items():
                    yield _scaled(some, cases, group, sides, factor, unit, special)


def _scaled(
    some: tuple[str, ...],
    cases: Sequence[str],
    group: Sequence[str],
    sides: Sequence[int],
    factor: float,
    unit: str,
    price: float,
) -> ChannelFault:
    names = [channel_name(r, sides[0] if len(sides) == 1 else None) for r in group]
    slope, rest = _ones()
    rows = [row(c) for c in some]
    for response in group:
        for side in sides:
            slope[rows, column(response), side] = 1.0 / factor
            if response == "tyre_load":
                rest[rows, side] = 1.0 / factor
    what = " and ".join(names)
    where = _where(some, cases)
    has, are = ("has", "is") if len(names) == 1 else ("have", "are")
    if factor < 0.0:
        words, cure, kind = (
            f"{what} {has} the opposite sign {where}",
            "give it sign = -1 in the channel map",
            "sign",
        )
    elif unit.startswith("the total"):
        words, kind = f"{what} {are} {unit} {where}", "unit"
        cure = "export it per wheel, or give it scale = 0.5 in the channel map"
        price += 2.0
    else:
        words, kind = f"{what} {are} in {unit} {where}", "unit"
        cure = "give its unit in the channel map or the heading"
        price += 1.0
    return ChannelFault(
        kind=kind,
        cases=some,
        channel="/".join(names),
        price=price,
        words=words,
        cure=cure,
        slope=slope,
        rest=rest,
        unit=unit if kind == "unit" else "",
    )


def _ones() -> tuple[FloatArray, FloatArray]:
    return np.ones((len(CASE_ORDER), len(RIG_RESPONSES), 2)), np.ones((len(CASE_ORDER), 2))


def _scaled_inputs(cases: Sequence[str]) -> Iterator[ChannelFault]:
    by_channel: dict[str, list[str]] = {}
    for case in cases:
        by_channel.setdefault(LOAD_CASES[case].channel, []).append(case)
    for channel, own in by_channel.items():
        sets = [tuple(own), *((c,) for c in own)] if len(own) > 1 else [tuple(own)]
        for some in sets:
            slope, _ = _ones()
            slope[[row(c) for c in some]] = -1.0
            yield ChannelFault(
                kind="input_sign",
                cases=some,
                channel=channel,
                price=2.0 + 0.5 * len(some),
                words=f"the input {channel} has the opposite sign {_where(some, cases)}",
                cure="give it sign = -1 in the channel map",
                slope=slope,
            )


def _axes(cases: Sequence[str]) -> Iterator[ChannelFault]:
    """Displacements and forces along one axis reversed together: another frame."""
    for axis, response, channel in (("X", "wc_x", "force_x"), ("Y", "wc_y", "force_y")):
        own = [c for c in cases if LOAD_CASES[c].channel == channel]
        if not own:
            continue
        slope, _ = _ones()
        slope[:, column(response)] *= -1.0
        slope[[row(c) for c in own]] *= -1.0
        yield ChannelFault(
            kind="sign",
            cases=tuple(cases),
            channel=channel_name(response),
            price=3.5,
            words=f"displacements and forces along {axis} both have the opposite sign",
            cure="give the rig's axes by frame in the channel map",
            slope=slope,
        )


def _exchanged_sides(cases: Sequence[str]) -> Iterator[ChannelFault]:
    for some, price in _places(cases):
        for group in (tuple(RIG_RESPONSES), *((r,) for r in RIG_RESPONSES)):
            order = _order()
            for case in some:
                for response in group:
                    at = row(case), column(response)
                    order[at] = order[at][::-1].copy()
            whole = len(group) > 1
            name = "*" if whole else channel_name(group[0])
            what = "left and right are" if whole else f"left and right {name} are"
            yield ChannelFault(
                kind="sides",
                cases=some,
                channel=name,
                price=price + (0.0 if whole else 0.5),
                words=f"{what} exchanged {_where(some, cases)}",
                cure="exchange the sides in the channel map",
                order=order.reshape(-1),
            )


def _exchanged_columns(cases: Sequence[str]) -> Iterator[ChannelFault]:
    for some, price in _places(cases):
        for one, other in combinations(RIG_RESPONSES, 2):
            for sides in ((0, 1), (0,), (1,)):
                order = _order()
                for case in some:
                    a, b = (row(case), column(one)), (row(case), column(other))
                    for side in sides:
                        order[a][side], order[b][side] = order[b][side].copy(), order[a][side].copy()
                side_name = sides[0] if len(sides) == 1 else None
                names = channel_name(one, side_name), channel_name(other, side_name)
                yield ChannelFault(
                    kind="columns",
                    cases=some,
                    channel=f"{names[0]}/{names[1]}",
                    price=price + 1.0 + (0.0 if len(sides) == 2 else 1.0),
                    words=f"{names[0]} and {names[1]} are exchanged {_where(some, cases)}",
                    cure="exchange them in the channel map",
                    order=order.reshape(-1),
                )


def _exchanged_cases(cases: Sequence[str], counter_phase: bool) -> Iterator[ChannelFault]:
    """Two files exchanged, or one given for another's load case."""
    groups = (*SAME_INPUT, ("vertical", "roll")) if counter_phase else SAME_INPUT
    for group in groups:
        for one, other in combinations(group, 2):
            for replaced in ({one: other, other: one}, {one: other}, {other: one}):
                present = [c for c in replaced if c in cases]
                if len(present) < len(replaced):
                    continue
                source = np.arange(len(CASE_ORDER))
                for case, really in replaced.items():
                    source[row(case)] = row(really)
                case, really = next(iter(replaced.items()))
                words = f"the records of {one} and {other} are exchanged"
                if len(replaced) == 1:
                    words = f"the record of {case} is one of {really}"
                yield ChannelFault(
                    kind="load_case",
                    cases=tuple(replaced),
                    channel="*",
                    price=2.0 + (0.0 if len(replaced) == 2 else 1.0),
                    words=words,
                    cure="list each file under its own load case in [records]",
                    source=source,
                )


def _order() -> IntArray:
    return np.arange(np.prod(_SHAPE)).reshape(_SHAPE)
