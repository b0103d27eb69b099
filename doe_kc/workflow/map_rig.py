"""Map: a folder of a rig's own files to a `test.toml` for the user to confirm, with reasons."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from doe_kc.axle import Axle
from doe_kc.curves import RIG_RESPONSES, SIDES
from doe_kc.ground.errors import InputError
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES
from doe_kc.measurement.branches import RunCurves, reduce_case
from doe_kc.measurement.channel_map import INPUT_UNITS, QUANTITY_UNITS, channel_map
from doe_kc.measurement.channels import RIG_NAMES, TIME
from doe_kc.measurement.checks import RecordFinding
from doe_kc.measurement.containers import READABLE, read_table, table_parts
from doe_kc.measurement.manifest import Manifest
from doe_kc.measurement.map_file import MapEntry, MapFile
from doe_kc.measurement.map_proposal import (
    ChannelGuess,
    distinct,
    guess_case,
    guess_channel,
    reversed_sign,
)
from doe_kc.measurement.records import record_from_table
from doe_kc.measurement.tables import ChannelTable
from doe_kc.measurement.units import unit_factor
from doe_kc.workflow.rig_checks import axle_curves, rig_findings


@dataclass(frozen=True)
class NamedTable:
    """A table of the folder. name: as [records] lists it. case: load case, None where it stays open."""

    name: str
    table: ChannelTable
    case: str | None


@dataclass(frozen=True)
class MapProposal:
    """channels: what was inferred. records: load case -> files. absent: what no file holds. ignored: channels
    that nothing is read from. open: what stays to be said by the user, in words. findings: of the checks on
    the records as mapped."""

    name: str
    channels: tuple[ChannelGuess, ...]
    records: Mapping[str, tuple[str, ...]]
    absent: tuple[str, ...]
    ignored: tuple[str, ...]
    open: tuple[str, ...]
    findings: tuple[RecordFinding, ...]


def propose_map(folder: Path, axle: Axle | None = None) -> MapProposal:
    """From names, units, ranges and the physics of the data.

    axle: that the records are of, for signs that only a model tells. InputError for a folder without a
    record.
    """
    tables, unread = _tables(folder)
    guesses = {g.name: g for t in tables for h in t.table.channels if (g := guess_channel(h)) is not None}
    channels, doubled = distinct(list(guesses.values()))
    channels = [_with_range(g, tables) for g in channels]
    proposal = _proposal(folder, tables, channels, [*unread, *doubled])
    proposal = replace(proposal, findings=_findings(folder, tables, proposal, axle))
    settled = _settled(proposal)
    if settled != proposal.channels:
        proposal = replace(proposal, channels=settled)
        proposal = replace(proposal, findings=_findings(folder, tables, proposal, axle))
    return proposal


def _tables(folder: Path) -> tuple[list[NamedTable], list[str]]:
    if not folder.is_dir():
        raise InputError(f"{folder}: is no folder; expected the folder of the rig's files, name that.")
    out: list[NamedTable] = []
    unread: list[str] = []
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() not in READABLE or not path.is_file() or path.name.startswith("."):
            continue
        file = path.relative_to(folder).as_posix()
        try:
            for part in table_parts(path):
                table = read_table(path, part, "")
                name = file if part is None else f"{file}#{part}"
                out.append(NamedTable(name, table, guess_case(part or "") or guess_case(path.stem)))
        except InputError as error:
            unread.append(f"{file} is not read: {str(error).removeprefix(f'{path}: ')}")
    if not out:
        raise InputError(
            f"{folder}: holds no record that can be read; {' '.join(unread) or 'expected files.'}"
        )
    return out, unread


def _with_range(guess: ChannelGuess, tables: Sequence[NamedTable]) -> ChannelGuess:
    """A unit that neither heading nor name tells, by the size of the numbers where only one fits."""
    if guess.unit is not None:
        return guess
    own = QUANTITY_UNITS[guess.quantity]
    if guess.quantity == "tyre_load":
        values = _values(guess.name, tables)
        level = float(np.median(np.abs(values))) if values.size else 0.0
        fits = [u for u in ("N", "kN", "kg") if 1000.0 < level * (unit_factor(u, "N") or 0.0) < 15000.0]
        if len(fits) == 1:
            return replace(
                guess, unit=fits[0], reason=f"{guess.reason}; {fits[0]} by its median of {level:.4g}"
            )
    return replace(guess, unit=own, reason=f"{guess.reason}; no unit stated, taken as {own}")


def _values(name: str, tables: Sequence[NamedTable]) -> np.ndarray:
    out = []
    for t in tables:
        for column, heading in enumerate(t.table.channels):
            if heading.name == name:
                try:
                    out.append(t.table.numbers(column))
                except InputError:
                    continue
    return np.concatenate(out) if out else np.array([])


def _proposal(
    folder: Path, tables: Sequence[NamedTable], channels: Sequence[ChannelGuess], questions: Sequence[str]
) -> MapProposal:
    records: dict[str, list[str]] = {}
    open_ones = list(questions)
    for t in tables:
        case = t.case or _case_by_sweep(t, channels)
        if case is None:
            open_ones.append(f"{t.name}: its load case is not told by name or sweep; list it in [records]")
        else:
            records.setdefault(case, []).append(t.name)
    slots = {g.slot for g in channels}
    wheel = [(RIG_NAMES[r], s) for r in RIG_RESPONSES for s in SIDES]
    absent = [f"{q}_{s}" for q, s in wheel if (q, s) not in slots] + [TIME] * ((TIME, None) not in slots)
    known = {g.name for g in channels}
    ignored = dict.fromkeys(
        h.name for t in tables for h in t.table.channels if h.name and h.name not in known
    )
    for case in [c for c in CASE_ORDER if c in records]:
        quantity = LOAD_CASES[case].channel
        if not any(g.quantity == quantity or (case == "roll" and g.quantity == "pad_z") for g in channels):
            open_ones.append(f"no channel is recognised as {quantity}, the input of {case}; map it")
    return MapProposal(
        folder.resolve().name,
        tuple(channels),
        {c: tuple(sorted(records[c], key=lambda n: (len(n), n))) for c in CASE_ORDER if c in records},
        tuple(absent),
        tuple(ignored),
        tuple(open_ones),
        (),
    )


def _case_by_sweep(t: NamedTable, channels: Sequence[ChannelGuess]) -> str | None:
    """The one load case whose input this table sweeps; None where several have that input."""
    swept = []
    for g in channels:
        if g.quantity not in INPUT_UNITS or g.name not in [h.name for h in t.table.channels]:
            continue
        column = [h.name for h in t.table.channels].index(g.name)
        factor = unit_factor(g.unit or "", INPUT_UNITS[g.quantity]) or 1.0
        span = float(np.ptp(t.table.numbers(column))) * factor
        cases = [c for c in CASE_ORDER if LOAD_CASES[c].channel == g.quantity]
        if span > 2.0 * LOAD_CASES[cases[0]].window:
            swept.append(cases)
    return swept[0][0] if len(swept) == 1 and len(swept[0]) == 1 else None


def _findings(
    folder: Path, tables: Sequence[NamedTable], proposal: MapProposal, axle: Axle | None
) -> tuple[RecordFinding, ...]:
    """Of the checks; a record that cannot be read through the map is one too."""
    channels = channel_map(map_file(proposal), folder, str(folder))
    by_name = {t.name: t.table for t in tables}
    runs: dict[str, tuple[RunCurves, ...]] = {}
    refused = []
    for case, names in proposal.records.items():
        try:
            runs[case] = reduce_case([record_from_table(by_name[n], case, channels) for n in names])
        except InputError as error:
            where, _, rest = str(error).partition(": ")
            refused.append(RecordFinding("record", "error", case, "*", where, rest.rstrip("."), "see above"))
    manifest = Manifest(name=proposal.name, records=dict(proposal.records))
    model = None if axle is None else axle_curves(axle)
    return (*refused, *rig_findings(folder / "test.toml", manifest, runs, model))


def _settled(proposal: MapProposal) -> tuple[ChannelGuess, ...]:
    """Signs, and units that nobody stated, where the checks are certain of them in every load case."""
    channels = list(proposal.channels)
    for finding in proposal.findings:
        if finding.severity != "error" or finding.kind not in ("sign", "unit", "input_sign"):
            continue
        if finding.kind == "input_sign" and not _only_case(proposal, finding):
            continue
        if finding.kind != "input_sign" and finding.case != "*":
            continue
        for i, g in enumerate(channels):
            own = g.quantity if g.side is None else f"{g.quantity}_{g.side}"
            if not {own, g.quantity} & set(finding.channel.split("/")):
                continue
            if finding.kind == "unit":
                if "taken as" in g.reason:
                    reason = g.reason.partition("; no unit")[0]
                    channels[i] = replace(
                        g, unit=finding.unit, reason=f"{reason}; {finding.unit} by its slopes"
                    )
            else:
                channels[i] = reversed_sign(g, "sign by its slopes")
    return tuple(channels)


def _only_case(proposal: MapProposal, finding: RecordFinding) -> bool:
    """Whether the input's sign is wrong in all load cases that have this input."""
    own = [c for c in proposal.records if LOAD_CASES[c].channel == finding.channel]
    wrong = [f.case for f in proposal.findings if f.kind == "input_sign" and f.channel == finding.channel]
    return set(own) == set(wrong) or finding.case == "*"


def map_file(proposal: MapProposal) -> MapFile:
    """The proposal as `[channels]` of a `test.toml`."""
    return MapFile(absent=list(proposal.absent), map={g.name: [_entry(g)] for g in proposal.channels})


def _entry(g: ChannelGuess) -> MapEntry:
    return MapEntry.model_validate({"quantity": g.quantity, "side": g.side, "unit": g.unit, "sign": g.sign})


def manifest_text(proposal: MapProposal) -> str:
    """The proposed `test.toml`, reasons as comments."""
    quote = json.dumps
    lines = [
        "# Proposed by `doe-kc map`: read it, correct it, and complete what is open.",
        f"name = {quote(proposal.name, ensure_ascii=False)}",
        *(f"# open: {q}" for q in proposal.open),
        "",
        "# [alignment]   # static angles of the bench, deg",
        "# left = { toe_deg = 0.0, camber_deg = 0.0, caster_deg = 0.0 }",
        "# right = { toe_deg = 0.0, camber_deg = 0.0, caster_deg = 0.0 }",
        "",
        "[channels]",
        *([f"absent = {quote(list(proposal.absent))}"] if proposal.absent else []),
        "",
        "[channels.map]",
        *(_map_line(g) for g in proposal.channels),
        *(f"# ignored: {quote(n, ensure_ascii=False)}" for n in proposal.ignored),
        "",
        "[records]   # main run first, then its repeats",
        *(f"{c} = {quote(list(n), ensure_ascii=False)}" for c, n in proposal.records.items()),
    ]
    return "\n".join(lines) + "\n"


def _map_line(g: ChannelGuess) -> str:
    side = "" if g.side is None else f', side = "{g.side}"'
    unit = "" if g.unit is None else f", unit = {json.dumps(g.unit, ensure_ascii=False)}"
    sign = "" if g.sign > 0 else ", sign = -1"
    name = json.dumps(g.name, ensure_ascii=False)
    return f'{name} = {{ quantity = "{g.quantity}"{side}{unit}{sign} }}   # {g.reason}'


def proposal_lines(proposal: MapProposal) -> Iterator[str]:
    """For a terminal: what was inferred and why, what is ignored, what stays open."""
    for g in proposal.channels:
        what = g.quantity if g.side is None else f"{g.quantity}_{g.side}"
        yield f"{g.name:34s} -> {'-' if g.sign < 0 else ' '}{what:14s} [{g.unit or '?'}]  ({g.reason})"
    for case, names in proposal.records.items():
        yield f"{case:17s} {', '.join(names)}"
    if proposal.absent:
        yield f"not measured: {', '.join(proposal.absent)}"
    if proposal.ignored:
        yield f"ignored: {', '.join(proposal.ignored)}"
    for question in proposal.open:
        yield f"open: {question}"
