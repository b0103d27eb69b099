"""Channels far noisier than the same channel of the other wheel and of the other records."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from doe_kc.curves import RIG_RESPONSES
from doe_kc.measurement.checks._base import RecordFinding, RigTest, channel_name, rig_check

TIMES = 5.0
"""Of the usual noise of the response over all records and both wheels."""
STATED_TIMES = 3.0
"""Of the stated resolution: less does no harm."""


@rig_check
def noise(test: RigTest) -> Iterator[RecordFinding]:
    """Of each response over all records."""
    for response in RIG_RESPONSES:
        levels = [
            (case, run.record, side, float(run.record.white[response][side]))
            for case, runs in test.runs.items()
            for run in runs
            if response in run.record.channels
            for side in (0, 1)
        ]
        usual = float(np.median([level for *_, level in levels])) if len(levels) > 2 else np.inf
        for case, record, side, level in levels:
            slope = test.resolution(response)
            if level > TIMES * usual and level > STATED_TIMES * slope:
                channel = channel_name(response, side)
                yield RecordFinding(
                    kind="noise",
                    severity="warning",
                    case=case,
                    channel=channel,
                    where=record.label,
                    evidence=f"{channel} has noise of {level:.2g}, {level / usual:.0f} times that of the "
                    "other records",
                    cure="check cable, shielding and filter and record it again",
                )
