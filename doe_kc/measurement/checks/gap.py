"""Missing stretches: leaps of the time or of the input from one sample to the next."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from doe_kc.measurement.checks._base import RecordFinding, RigTest, rig_check
from doe_kc.measurement.outliers import running_median

LEAP = 4.0
"""Times the usual step of time or input."""
MISSED = 0.03
"""Share of the input's range that passes unrecorded, from which it is told."""
SERIOUS = 0.15
"""Share from which the curve has a hole of several points of its grid."""


@rig_check
def gaps(test: RigTest) -> Iterator[RecordFinding]:
    """The largest leap of each record."""
    for case, runs in test.runs.items():
        for record in (run.record for run in runs):
            smooth = running_median(record.input)
            steps = np.abs(np.diff(record.input))
            share = steps / np.ptp(smooth)
            at = int(np.argmax(share))
            usual = float(np.quantile(steps, 0.9))
            if share[at] > MISSED and steps[at] > LEAP * usual:
                low, high = sorted((record.input[at], record.input[at + 1]))
                yield RecordFinding(
                    kind="gap",
                    severity="error" if share[at] > SERIOUS else "warning",
                    case=case,
                    channel="*",
                    where=record.label,
                    evidence=f"{record.case.channel} leaps between {low:g} and {high:g} "
                    f"{record.case.unit} at "
                    f"sample {at + 2}: {100 * share[at]:.0f} % of its range are missing",
                    cure="export the whole record or record it again",
                )
