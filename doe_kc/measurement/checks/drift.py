"""Drift: a steady loop comes back to where it began."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.checks._base import RecordFinding, RigTest, channel_name, rig_check
from doe_kc.measurement.noise import white_sd
from doe_kc.measurement.records import RigRecord

END_SAMPLES = 10
"""Samples at each end of the record that are compared on their common line over the input."""
NOISE_TIMES = 9.0
"""Standard deviations of the difference of the two ends that noise may bring about."""
RANGE_SHARE = 0.02
"""Share of the channel's range by which a loop may stay open from relaxation of rubber."""


@rig_check
def drift(test: RigTest) -> Iterator[RecordFinding]:
    """Of each channel of records that begin and end at the same input.

    What all runs of a load case show alike is no drift but the wheel's own way.
    """
    for case, runs in test.runs.items():
        openings = [_openings(run.record) for run in runs]
        usual = np.median([o for o, _ in openings], axis=0) if len(runs) > 1 else 0.0
        for run, (opening, limit) in zip(runs, openings, strict=True):
            names = [channel_name(r, s) for r in run.record.channels for s in (0, 1)]
            for at in np.flatnonzero((np.abs(opening) > limit) & (np.abs(opening - usual) > limit)):
                yield _finding(case, run.record, names[at], float(opening[at]))


def _openings(record: RigRecord) -> tuple[FloatArray, FloatArray]:
    """(k,) end minus beginning at the same input of each channel, and what noise and the coarseness of
    samples allow
    of it; nan where the record is no closed loop."""
    values = np.concatenate(list(record.channels.values()))
    n, u = END_SAMPLES, record.input
    span = float(np.ptp(u))
    step = 2.0 * span / u.size
    if u.size < 6 * n or abs(u[0] - u[-1]) > 3.0 * step + 0.01 * span:
        return np.full(len(values), np.nan), np.full(len(values), np.nan)
    inputs = np.concatenate([u[:n], u[-n:]])
    ends = np.concatenate([values[:, :n], values[:, -n:]], axis=1)
    basis = np.stack([np.ones(2 * n), inputs - inputs.mean(), np.repeat([0.0, 1.0], n)], axis=1)
    _, slope, opening = np.linalg.pinv(basis) @ ends.T
    white = np.concatenate(list(record.white.values()))
    sd = np.hypot(white, np.abs(slope) * white_sd(u[None, :])) * (2.0 / n) ** 0.5
    # A sample's neighbours lie a step of the input apart: the line is that coarse.
    limit = NOISE_TIMES * sd + RANGE_SHARE * np.ptp(values, axis=1) + np.abs(slope) * step
    return opening, limit


def _finding(case: str, record: RigRecord, channel: str, opening: float) -> RecordFinding:
    return RecordFinding(
        kind="drift",
        severity="warning",
        case=case,
        channel=channel,
        where=record.label,
        evidence=f"{channel} ends {opening:+.3g} from where it began at the same input",
        cure="let the rig run warm and settle, then record the loop again; the mean curve is moved by "
        "half of it at most",
    )
