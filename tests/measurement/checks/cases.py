"""The shipped example's records with something done to them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd

from doe_kc.curves import CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Manifest, load_manifest
from doe_kc.measurement.branches import RunCurves, reduce_case
from doe_kc.measurement.channels import parse_heading
from doe_kc.measurement.checks import RecordFinding, RigTest, check_test
from doe_kc.measurement.records import own_names, record_from_table
from doe_kc.measurement.tables import ArrayTable
from tests.measurement.synthetic import EXAMPLE

Columns = dict[str, FloatArray]
Edit = Callable[[str, int, Columns], None]
"""Load case, run and columns by heading, changed in place."""


@cache
def sound(case: str) -> tuple[Mapping[str, FloatArray], ...]:
    """Columns of main run and repeats."""
    names = load_manifest(EXAMPLE / "test.toml").records[case]
    frames = [pd.read_csv(EXAMPLE / name) for name in names]
    return tuple({c: f[c].to_numpy(float) for c in f.columns} for f in frames)


def cases() -> tuple[str, ...]:
    return tuple(load_manifest(EXAMPLE / "test.toml").records)


def runs_of(case: str, edit: Edit | None = None) -> tuple[RunCurves, ...]:
    records = []
    for k, columns in enumerate(sound(case)):
        own = dict(columns)
        if edit is not None:
            edit(case, k, own)
        table = ArrayTable(
            f"{case}_{k}", tuple(parse_heading(c) for c in own), tuple(np.asarray(v) for v in own.values())
        )
        records.append(record_from_table(table, case, own_names()))
    return reduce_case(records)


@cache
def _sound_runs(case: str) -> tuple[RunCurves, ...]:
    return runs_of(case)


def findings(
    edit: Edit | None = None,
    *,
    changed: tuple[str, ...] | None = None,
    model: CurveSet | None = None,
    manifest: Manifest | None = None,
) -> tuple[RecordFinding, ...]:
    """Of all checks; changed: load cases that `edit` touches, by default all."""
    touched = cases() if changed is None else changed
    runs = {c: runs_of(c, edit) if edit is not None and c in touched else _sound_runs(c) for c in cases()}
    own = manifest or load_manifest(EXAMPLE / "test.toml")
    return check_test(RigTest(Path("test.toml"), own, runs, model))
