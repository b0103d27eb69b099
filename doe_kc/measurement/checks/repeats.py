"""Repeats that disagree by more than the rig's own scatter, and how: offset, gain, sign, another test."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.branches import RunCurves, static_index
from doe_kc.measurement.checks._base import RecordFinding, RigTest, Severity, channel_name, rig_check
from doe_kc.measurement.noise_estimation import SENSOR_KINDS

WARN, REFUSE = 5.0, 15.0
"""Times the usual scatter of the kind of sensor from which repeats are told to disagree, and are refused."""
GAIN_SHARE = 0.004
"""Of the channel's range, added to that scatter: a rig's gain varies by 0.2 % from run to run."""
MOST_CHANNELS = 0.5
"""Share of a run's channels from which their common cause is the input, or another test."""


@dataclass(frozen=True)
class Deviation:
    """A run's channel against the other runs. score: times the usual scatter. gain, offset: of the line
    through it over theirs; rest: what that leaves, share of the deviation."""

    response: str
    side: int
    run: int
    score: float
    gain: float
    offset: float
    rest: float


@rig_check
def repeats(test: RigTest) -> Iterator[RecordFinding]:
    """Of each load case with repeats."""
    usual = usual_scatter(test)
    for case, runs in test.runs.items():
        for k, own in _by_run(_deviations(test, runs, usual)).items():
            yield from _findings(case, runs, k, own)


@lru_cache(maxsize=16)
def odd_runs(test: RigTest, case: str) -> frozenset[int]:
    """Runs of a load case that differ from the others by what is refused."""
    deviations = _deviations(test, test.runs[case], usual_scatter(test))
    return frozenset(d.run for d in deviations if d.score > REFUSE and len(test.runs[case]) > 2)


@lru_cache(maxsize=2)
def usual_scatter(test: RigTest) -> dict[str, float]:
    """Response -> rms of its runs' scatter: the larger of its median over load cases and sides and of that of
    its kind of sensor, at least half the resolution."""
    out = {}
    for responses in SENSOR_KINDS.values():
        scatter = {
            r: [
                value
                for runs in test.runs.values()
                if len(runs) > 1 and r in runs[0].record.channels
                for value in np.sqrt(np.mean(np.var(_values(runs, r), axis=0, ddof=1), axis=-1))
            ]
            for r in responses
        }
        pooled = _median([value for values in scatter.values() for value in values])
        for r in responses:
            out[r] = max(pooled, _median(scatter[r]), 0.5 * test.resolution(r))
    return out


def _median(values: Sequence[float]) -> float:
    known = [v for v in values if np.isfinite(v)]
    return float(np.median(known)) if known else 0.0


def _values(runs: Sequence[RunCurves], response: str) -> FloatArray:
    return np.stack([run.mean(response) for run in runs])


def _deviations(test: RigTest, runs: Sequence[RunCurves], usual: dict[str, float]) -> list[Deviation]:
    out = []
    for response in RIG_RESPONSES if len(runs) > 1 else ():
        if response not in runs[0].record.channels:
            continue
        values = _values(runs, response)
        for side in (0, 1):
            centre = np.median(values[:, side], axis=0)
            for k, curve in enumerate(values[:, side]):
                others = np.delete(values[:, side], k, axis=0).mean(axis=0) if len(runs) < 3 else centre
                level = usual[response] + GAIN_SHARE * float(np.ptp(others))
                score = float(np.sqrt(np.mean((curve - others) ** 2))) / level
                if score > WARN:
                    out.append(Deviation(response, side, k, score, *_line(curve, others)))
    return out


def _line(curve: FloatArray, others: FloatArray) -> tuple[float, float, float]:
    """Gain, offset at static, and the share that the line leaves of the deviation."""
    d = others - others.mean()
    gain = float(d @ curve / max(float(d @ d), 1e-300))
    offset = float(curve.mean() - gain * others.mean())
    left = curve - gain * others - offset
    share = float(np.sqrt(np.mean(left**2) / max(float(np.mean((curve - others) ** 2)), 1e-300)))
    return gain, offset, share


def _by_run(deviations: Sequence[Deviation]) -> dict[int, list[Deviation]]:
    out: dict[int, list[Deviation]] = {}
    for d in deviations:
        out.setdefault(d.run, []).append(d)
    return out


def _findings(
    case: str, runs: Sequence[RunCurves], k: int, own: Sequence[Deviation]
) -> Iterator[RecordFinding]:
    if len(runs) == 2 and k == 0:
        return
    label = runs[k].record.label
    other = "the other runs" if len(runs) > 2 else runs[0].record.label
    strongest = max(own, key=lambda d: d.score)
    severity: Severity = "error" if strongest.score > REFUSE else "warning"
    channels = 2 * len(runs[k].record.channels)
    if len(own) > MOST_CHANNELS * channels:
        yield RecordFinding(
            kind="repeat",
            severity=severity,
            case=case,
            channel="*",
            where=label,
            evidence=f"{len(own)} of {channels} channels differ from {other}, {_common(runs, k)}",
            cure="list the right file, or drop this run",
        )
        return
    for d in own:
        channel = channel_name(d.response, d.side)
        yield RecordFinding(
            kind="repeat",
            severity="error" if d.score > REFUSE else "warning",
            case=case,
            channel=channel,
            where=label,
            evidence=f"{channel} differs from {other} by {d.score:.0f} times the usual scatter, {_words(d)}",
            cure="check the sensor, then record the run again or drop it",
        )


def _words(d: Deviation) -> str:
    if d.rest > 0.5:
        return "in another shape"
    if abs(d.gain - 1.0) < 0.02:
        return f"by an offset of {d.offset:+.3g}"
    return "with the opposite sign" if abs(d.gain + 1.0) < 0.1 else f"as {d.gain:.3g} times their curve"


def _common(runs: Sequence[RunCurves], k: int) -> str:
    """Whether one input error explains all channels."""
    grid = runs[k].input
    at = static_index(grid)
    near = np.abs(grid) <= runs[k].record.case.window * 1.001
    ratios, shifts, weights = [], [], []
    for response in runs[k].record.channels:
        values = _values(runs, response)
        others = np.median(np.delete(values, k, axis=0), axis=0)
        for side in (0, 1):
            slope = float(np.polyfit(grid[near], others[side][near], 1)[0])
            ratios.append(float(np.polyfit(grid[near], values[k, side][near], 1)[0]) / slope)
            shifts.append((values[k, side, at] - others[side, at]) / slope)
            weights.append(float(np.ptp(others[side])))
    ratio, shift = float(np.median(ratios)), float(np.median(shifts))
    if np.median(np.abs(np.array(ratios) - ratio)) < 0.05 * abs(ratio) and abs(ratio - 1.0) > 0.03:
        return f"all as if its input were {ratio:.3g} times what it says"
    if np.median(np.abs(np.array(shifts) - shift)) < 0.3 * abs(shift) and abs(ratio - 1.0) < 0.2:
        return f"all as if its input were {shift:+.3g} {runs[k].record.case.unit} beside what it says"
    return "as those of another test or car"
