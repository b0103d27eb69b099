"""One rig record: a load case's channels over time, read through the channel map and checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import numpy as np

from doe_kc.curves import RIG_RESPONSES, SIDES
from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.measurement.channel_map import INPUT_ROLE, ChannelMap, ColumnTerm, named_map
from doe_kc.measurement.channels import TIME
from doe_kc.measurement.containers import read_table
from doe_kc.measurement.noise import white_sds
from doe_kc.measurement.outliers import Outlier, without_outliers
from doe_kc.measurement.tables import ChannelTable

MIRRORED_CASES = ("vertical", "lateral_opposite", "drive", "brake")
"""Load cases that are their own mirror image; in the others the right wheel at +u is the left one at -u."""
SYMMETRIC_SHARE = 0.05
"""Of the input's range: how far input and reversed input half a cycle later may differ."""


def with_mirror_image(
    label: str, case: LoadCase, values: Mapping[str, FloatArray], loop_input: FloatArray
) -> tuple[dict[str, FloatArray], tuple[str, ...]]:
    """Response -> (2, n) and the channels that were filled in by mirroring.

    values: role (`toe_L`) -> (n,). A response of neither wheel is left out. Where left and right differ in
    input, the mirror image is the other wheel half a cycle later. InputError for a record that is no
    symmetric
    cycle.
    """
    out: dict[str, FloatArray] = {}
    filled: list[str] = []
    for response in RIG_RESPONSES:
        sides = [values.get(f"{response}_{s}") for s in SIDES]
        measured = next((v for v in sides if v is not None), None)
        if measured is None:
            continue
        if any(v is None for v in sides):
            filled.append(f"{response}_{SIDES[0 if sides[0] is None else 1]}")
            sign = -1.0 if response == "wc_y" else 1.0
            image = sign * _half_cycle_later(label, case, measured, loop_input)
            sides = [image if v is None else v for v in sides]
        out[response] = np.stack([v for v in sides if v is not None])
    return out, tuple(filled)


def _half_cycle_later(label: str, case: LoadCase, values: FloatArray, loop_input: FloatArray) -> FloatArray:
    if case.id in MIRRORED_CASES:
        return values
    shift = values.size // 2
    later = np.roll(loop_input, -shift)
    if np.abs(later + loop_input).max() > SYMMETRIC_SHARE * np.ptp(loop_input):
        raise InputError(
            f"{label}: holds one wheel in a load case that moves the wheels differently, and is no symmetric "
            f"cycle through ±{case.amplitude:g} {case.unit}; expected that to mirror it, record both wheels."
        )
    return np.asarray(np.roll(values, -shift))


MIN_SAMPLES = 24
"""Of a loop: fewer leave under a dozen points a branch, of which two or three are in the fit window."""
OWN_NAMES = "doe_kc"
"""Preset of the package's own channel names."""


@dataclass(frozen=True)
class RigRecord:
    """Samples of one run, as recorded.

    label: file (and sheet), for messages. case: the load case as the rig ran it.
    time: (n,) s, strictly increasing; the samples' numbers where no time was recorded.
    input: (n,) in `case.unit`.
    channels: response (`RIG_RESPONSES`) -> (2, n), left and right; deg, mm, N; changes from static
        for angles and wheel centre, tyre load absolute. A response of neither wheel is left out.
    ignored: headings of columns that nothing is read from. outliers: samples replaced by their neighbours.
    mirrored: channels (`toe_R`) that were not measured and are the other wheel's mirror image.
    """

    label: str
    case: LoadCase
    time: FloatArray
    input: FloatArray
    channels: Mapping[str, FloatArray]
    ignored: tuple[str, ...] = ()
    outliers: tuple[Outlier, ...] = ()
    mirrored: tuple[str, ...] = ()

    @cached_property
    def white(self) -> Mapping[str, FloatArray]:
        """Response -> (2,) sd of its sensors' white noise, left and right, in its unit."""
        levels = white_sds(np.concatenate(list(self.channels.values()))).reshape(-1, 2)
        return dict(zip(self.channels, levels, strict=True))


def read_record(
    path: Path, load_case: str, *, sheet: str | None = None, channels: ChannelMap | None = None
) -> RigRecord:
    """Read and check one record; every fault is an InputError naming file, place, expectation, remedy.

    load_case: id in `LOAD_CASES`. sheet: of an Excel workbook, or part of another container; None = the only
    one or the one named like the load case. channels: the rig's channel map, by default that of the package's
    own names.
    """
    return record_from_table(read_table(path, sheet, load_case), load_case, channels or own_names())


@cache
def own_names() -> ChannelMap:
    """Map of the package's own channel names."""
    return named_map(OWN_NAMES, Path(), OWN_NAMES)


def record_from_table(table: ChannelTable, load_case: str, channels: ChannelMap) -> RigRecord:
    """Check the columns, numbers and sweep of a raw table."""
    columns = channels.columns(table.label, table.channels, load_case)
    case = columns.case
    if table.size < MIN_SAMPLES:
        raise InputError(
            f"{table.label}: has {table.size} samples, expected at least {MIN_SAMPLES} in a loop; "
            "record at a higher rate or export the whole loop."
        )
    raw = {role: _combined(table, terms) for role, terms in columns.terms.items()}
    time = raw.pop(TIME, np.arange(table.size, dtype=float))
    _check_time(table, time)
    values, outliers = without_outliers(raw, INPUT_ROLE)
    _check_sweep(table.label, case, values[INPUT_ROLE])
    responses, mirrored = with_mirror_image(table.label, case, values, values[INPUT_ROLE])
    return RigRecord(
        table.label, case, time, values[INPUT_ROLE], responses, columns.ignored, outliers, mirrored
    )


def _combined(table: ChannelTable, terms: Sequence[ColumnTerm]) -> FloatArray:
    """(n,) sum of factor * (recorded - offset)."""
    parts = [_scaled(table.numbers(t.column), t) for t in terms]
    return parts[0] if len(parts) == 1 else np.asarray(np.sum(parts, axis=0))


def _scaled(values: FloatArray, term: ColumnTerm) -> FloatArray:
    if term.offset:
        values = values - term.offset
    return values if term.factor == 1.0 else term.factor * values


def _check_time(table: ChannelTable, time: FloatArray) -> None:
    late = np.flatnonzero(np.diff(time) <= 0.0)
    if late.size:
        raise InputError(
            f"{table.label}: row {table.row(int(late[0]) + 1)}, time does not increase; expected samples "
            "in the order of recording, so sort or export the record again."
        )


def _check_sweep(label: str, case: LoadCase, values: FloatArray) -> None:
    low, high = float(values.min()), float(values.max())
    if high == low:
        raise InputError(
            f'{label}: column "{case.channel} [{case.unit}]" is constant at {low:g}; expected a loop '
            f"through ±{case.window:g} {case.unit} at least: is it the right file for {case.id}?"
        )
    if min(high, -low) < case.window:
        raise InputError(
            f'{label}: column "{case.channel} [{case.unit}]" covers {low:g} to {high:g}, expected '
            f"at least ±{case.window:g}, the fit window of {case.id}; record a larger loop "
            "or check the unit."
        )
    if high - low > 1e3 * case.amplitude:
        raise InputError(
            f'{label}: column "{case.channel} [{case.unit}]" covers {low:g} to {high:g}, expected about '
            f"±{case.amplitude:g}; check the unit."
        )
