"""Records of one branch, and of few samples: what they cannot tell."""

from __future__ import annotations

from collections.abc import Iterator

from doe_kc.measurement.checks._base import RecordFinding, RigTest, rig_check

FEW_SAMPLES = 40
"""Samples a branch below which the gradients rest on a handful of points."""


@rig_check
def branches(test: RigTest) -> Iterator[RecordFinding]:
    """One finding a load case."""
    for case, runs in test.runs.items():
        record = runs[0].record
        if any(run.one_branch for run in runs):
            yield RecordFinding(
                kind="one_branch",
                severity="warning",
                case=case,
                channel="*",
                where=record.label,
                evidence="holds one branch of the loop: the loop is unknown, so that friction, play and "
                "rubber hysteresis cannot be tested, and the curve is off by half of it",
                cure="record the whole loop where these matter",
            )
        elif min(runs[0].loop.unload.size, runs[0].loop.load.size) < FEW_SAMPLES:
            yield RecordFinding(
                kind="few_samples",
                severity="warning",
                case=case,
                channel="*",
                where=record.label,
                evidence=f"has {record.input.size} samples in a loop, outliers and noise are hardly told",
                cure="export it at a higher rate",
            )
