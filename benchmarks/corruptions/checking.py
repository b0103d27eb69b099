"""A car with a corruption, and what the checks tell of it."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

import pandas as pd
from corruptions.edit import Corruption, Frames

from doe_kc.curves import CurveSet
from doe_kc.ground.errors import InputError
from doe_kc.load_cases import CASE_ORDER
from doe_kc.measurement import load_manifest
from doe_kc.measurement.branches import RunCurves, reduce_case
from doe_kc.measurement.channels import parse_heading
from doe_kc.measurement.records import own_names, record_from_table
from doe_kc.measurement.tables import ArrayTable
from doe_kc.workflow.rig_checks import rig_findings


@dataclass(frozen=True)
class Told:
    """What the checks said of a car: findings as (severity, kind, case, channel), or a refusal."""

    findings: tuple[tuple[str, str, str, str], ...]
    refusal: str = ""


@dataclass(frozen=True)
class Car:
    """A test: its `test.toml` and records by file name, and the reduced runs of its load cases."""

    folder: Path
    text: str
    frames: Frames
    runs: dict[str, tuple[RunCurves, ...]]


def read_car(folder: Path) -> Car:
    """As its files are."""
    frames = {p.stem: pd.read_csv(p) for p in sorted(folder.glob("*.csv"))}
    text = (folder / "test.toml").read_text(encoding="utf-8")
    car = Car(folder, text, frames, {})
    for case in (c for c in CASE_ORDER if c in frames):
        car.runs[case] = reduced(frames, case)
    return car


def reduced(frames: Frames, case: str) -> tuple[RunCurves, ...]:
    """Of a load case, by the way of every record: channel map, checks of the sweep, outliers, branches."""
    return reduce_case(
        [
            record_from_table(table(name, frame), case, own_names())
            for name, frame in frames.items()
            if name.split("_repeat")[0] == case
        ]
    )


def table(name: str, frame: pd.DataFrame) -> ArrayTable:
    """A frame as a container would give it."""
    headings = tuple(parse_heading(c) for c in frame.columns)
    return ArrayTable(name, headings, tuple(frame[c].to_numpy(float) for c in frame.columns))


def told(car: Car, corruption: Corruption | None, model: CurveSet | None) -> Told:
    """What `doe-kc check` tells of a car's records with a corruption."""
    frames = {name: frame.copy() for name, frame in car.frames.items()}
    text = car.text
    if corruption is not None:
        if corruption.edit is not None:
            corruption.edit(frames)
        text = corruption.text(text) if corruption.text else text
    runs, refusal = {}, ""
    for case, sound in car.runs.items():
        names = [n for n in frames if n.split("_repeat")[0] == case]
        if all(frames[n].equals(car.frames[n]) for n in names):
            runs[case] = sound
            continue
        try:
            runs[case] = reduced(frames, case)
        except InputError as error:
            refusal = str(error)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.toml"
        path.write_text(text, encoding="utf-8")
        findings = rig_findings(path, load_manifest(path), runs, model)
    return Told(tuple((f.severity, f.kind, f.case, f.channel) for f in findings), refusal)


def right(corruption: Corruption, outcome: Told) -> bool:
    """Whether a finding, or the refusal, has the right kind and channel."""
    if "refused" in corruption.kinds and outcome.refusal:
        return corruption.channel.strip("*") in outcome.refusal
    return any(
        kind in corruption.kinds and (corruption.channel == "*" or fnmatchcase(channel, corruption.channel))
        for _, kind, _, channel in outcome.findings
    )


def cars_of(folders: Sequence[Path]) -> list[Path]:
    return [p.parent for folder in folders for p in sorted(folder.glob("*/test.toml"))]
