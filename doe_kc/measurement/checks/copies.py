"""The same samples under two names: a wheel's channel given for the other's, a file given for two cases."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from doe_kc.measurement.checks._base import RecordFinding, RigTest, channel_name, rig_check
from doe_kc.measurement.records import RigRecord


@rig_check
def copies(test: RigTest) -> Iterator[RecordFinding]:
    """Within each record, then between the records of different load cases."""
    records = [(case, run.record) for case, runs in test.runs.items() for run in runs]
    for case, record in records:
        yield from _channels(case, record)
    for (case, one), (other_case, other) in combinations(records, 2):
        if case != other_case and _same_file(one, other):
            yield RecordFinding(
                kind="load_case",
                severity="error",
                case=other_case,
                channel="*",
                where=other.label,
                evidence=f"holds the same samples as {one.label}, which is the record of {case}",
                cure="list the right file for each load case",
            )


def _channels(case: str, record: RigRecord) -> Iterator[RecordFinding]:
    names = {
        channel_name(r, s): v
        for r, sides in record.channels.items()
        for s, v in enumerate(sides)
        if f"{r}_{'LR'[s]}" not in record.mirrored
    }
    for (name, one), (other_name, other) in combinations(names.items(), 2):
        if np.array_equal(one, other) and np.ptp(one) > 0.0:
            yield RecordFinding(
                kind="copy",
                severity="error",
                case=case,
                channel=other_name,
                where=record.label,
                evidence=f"{other_name} holds the same samples as {name}",
                cure="export the right channel, or correct the map",
            )


def _same_file(one: RigRecord, other: RigRecord) -> bool:
    if one.input.shape != other.input.shape:
        return False
    response = next(iter(one.channels))
    return response in other.channels and np.array_equal(one.channels[response], other.channels[response])
