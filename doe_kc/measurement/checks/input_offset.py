"""An input that is not zero where it says so: at its zero all channels have moved, each by its slope."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from doe_kc.curves import TYRE_LOAD
from doe_kc.measurement.branches import RunCurves, static_index
from doe_kc.measurement.checks._base import RecordFinding, RigTest, rig_check
from doe_kc.measurement.checks.repeats import odd_runs, usual_scatter

OFFSET_SHARE = 0.01
"""Of the sweep: a smaller offset moves no characteristic by what matters."""
EXPLAINED = 0.85
"""Share of the channels' squared values at zero input that one offset explains."""
OFFSET_SDS = 8.0
"""Standard deviations."""
SERIOUS_OFFSET = 0.1
"""Share of the sweep's amplitude from which it is an error: the fit window is a quarter to a half of it,
and would lie off static by a fifth to two fifths of itself."""


@rig_check
def input_offset(test: RigTest) -> Iterator[RecordFinding]:
    """Of each load case; the tyre load's rest is that of the other load cases."""
    usual = usual_scatter(test)
    rest = _rest_loads(test)
    for case, runs in test.runs.items():
        offset, sd, explained = _offset(test, case, usual, rest)
        record = runs[0].record
        share = abs(offset) / record.case.amplitude
        if share > OFFSET_SHARE and abs(offset) > OFFSET_SDS * sd and explained > EXPLAINED:
            yield RecordFinding(
                kind="input_offset",
                severity="error" if share > SERIOUS_OFFSET else "warning",
                case=case,
                channel=record.case.channel,
                where=record.label,
                evidence=f"at {record.case.channel} = 0 the channels stand as at {offset:+.3g} "
                f"{record.case.unit} of their curves ({100 * explained:.0f} % explained)",
                cure=f"zero the input, or map it with offset = {-offset:.3g}",
            )


def _rest_loads(test: RigTest) -> np.ndarray | None:
    """(2,) tyre load at rest, the median over load cases; None from fewer than three."""
    loads = [
        np.mean([run.mean(TYRE_LOAD)[:, static_index(run.input)] for run in runs], axis=0)
        for runs in test.runs.values()
        if TYRE_LOAD in runs[0].record.channels
    ]
    return np.asarray(np.median(loads, axis=0)) if len(loads) > 2 else None


def _offset(
    test: RigTest,
    case: str,
    usual: dict[str, float],
    rest: np.ndarray | None,
) -> tuple[float, float, float]:
    """Weighted least squares of value at zero = slope * offset: offset, sd, share explained."""
    kept = [run for k, run in enumerate(test.runs[case]) if k not in odd_runs(test, case)] or list(
        test.runs[case]
    )
    values, slopes = [], []
    for response in kept[0].record.channels:
        curve = np.mean([run.mean(response) for run in kept], axis=0)
        at_zero = curve[:, static_index(kept[0].input)]
        if response == TYRE_LOAD:
            if rest is None:
                continue
            at_zero = at_zero - rest
        values += list(at_zero / usual[response])
        slopes += list(_slope(kept, curve) / usual[response])
    v, s = np.array(values), np.array(slopes)
    keep = np.isfinite(v) & np.isfinite(s)
    v, s = v[keep], s[keep]
    weight = float(s @ s)
    if weight == 0.0:
        return 0.0, np.inf, 0.0
    offset = float(s @ v) / weight
    left = v - offset * s
    return offset, float(np.sqrt(1.0 / weight)), 1.0 - float(left @ left) / max(float(v @ v), 1e-300)


def _slope(runs: Sequence[RunCurves], curve: np.ndarray) -> np.ndarray:
    grid = runs[0].input
    near = np.abs(grid) <= runs[0].record.case.window * 1.001
    return np.asarray(np.polyfit(grid[near], curve[:, near].T, 1)[0])
