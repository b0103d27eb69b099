"""Samples that were taken out as single outliers, and channels that have too many of them."""

from __future__ import annotations

from collections.abc import Iterator

from doe_kc.ground.listing import first_of
from doe_kc.measurement.channels import RIG_NAMES
from doe_kc.measurement.checks._base import RecordFinding, RigTest, rig_check
from doe_kc.measurement.records import RigRecord

MOST = 0.02
"""Share of a channel's samples beyond which its outliers are no single ones."""
LISTED_OUTLIERS = 4
"""That a sentence names; it tells how many more there are."""


@rig_check
def outliers(test: RigTest) -> Iterator[RecordFinding]:
    """One finding a channel of a record."""
    for case, runs in test.runs.items():
        for run in runs:
            for role in dict.fromkeys(o.role for o in run.record.outliers):
                yield _finding(case, run.record, role)


def _finding(case: str, record: RigRecord, role: str) -> RecordFinding:
    own = [o for o in record.outliers if o.role == role]
    listed = first_of([f"{o.value:g} at sample {o.sample + 1}" for o in own], LISTED_OUTLIERS)
    many = len(own) > MOST * record.input.size
    response, _, side = role.rpartition("_")
    channel = record.case.channel if role == "input" else f"{RIG_NAMES.get(response, role)}_{side}"
    return RecordFinding(
        kind="outlier",
        severity="error" if many else "warning",
        case=case,
        channel=channel if role != "time" else role,
        where=record.label,
        evidence=f"{channel} has {len(own)} outlying sample{'s' if len(own) > 1 else ''} ({listed})",
        cure="too many for a sound sensor, so mend it and record the channel again"
        if many
        else "replaced by their neighbours, nothing to do",
    )
