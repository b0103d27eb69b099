"""Dead, stuck and clipped channels: stretches of one and the same number while the rig moves."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from doe_kc.curves import TYRE_LOAD
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.checks._base import RecordFinding, RigTest, channel_name, rig_check
from doe_kc.measurement.noise import white_sd
from doe_kc.measurement.records import RigRecord

LONGEST = 8
"""Equal neighbouring samples that noise and resolution may bring about."""
USUAL_TIMES = 3.0
"""Times the length that 99 % of a channel's own equal stretches have: coarse resolution makes them long."""
MOVED = 0.03
"""Share of the input's range that passes meanwhile: not a dwell."""
ALIVE, DEAD_SDS = 18.0, 8.5
"""Standard deviations of noise that the range of a channel exceeds which shows something, and of one that
shows
noise alone does not (6.5 expected of 512 samples)."""


@rig_check
def flat(test: RigTest) -> Iterator[RecordFinding]:
    """Of every channel of every record, the input's too."""
    for runs in test.runs.values():
        for run in runs:
            yield from _record(run.record)


def _record(record: RigRecord) -> Iterator[RecordFinding]:
    for response, sides in record.channels.items():
        for side, values in enumerate(sides):
            fault = _fault(values, record.input) or _dead(sides, side)
            if fault is not None and not (response == TYRE_LOAD and fault[1] == 0.0):
                yield _finding(record, channel_name(response, side), fault)
    moving = record.channels["wc_z"] if "wc_z" in record.channels else next(iter(record.channels.values()))
    fault = _fault(record.input, np.nan_to_num(moving[0]))
    if fault is not None and fault[0] != "clipped":
        yield _finding(record, record.case.channel, fault)


def _fault(values: FloatArray, other: FloatArray) -> tuple[str, float, int, int] | None:
    """Kind, value, first sample and length of the longest flat stretch during which `other` moves."""
    if np.isnan(values).any() or np.count_nonzero(np.diff(values) == 0.0) < LONGEST:
        return None
    if np.ptp(values) == 0.0:
        return "dead", float(values[0]), 0, values.size
    changes = np.flatnonzero(np.diff(values)) + 1
    starts = np.concatenate([[0], changes])
    lengths = np.diff(np.append(starts, values.size))
    usual = USUAL_TIMES * float(np.quantile(lengths, 0.99)) if lengths.size > 4 * LONGEST else 0.0
    at = int(np.argmax(lengths))
    first, length = int(starts[at]), int(lengths[at])
    if length <= max(LONGEST, min(usual, values.size / 4)):
        return None
    if np.ptp(other[first : first + length]) < MOVED * np.ptp(other):
        return None
    value = float(values[first])
    extreme = value in (float(values.max()), float(values.min()))
    return "clipped" if extreme else "stuck", value, first, length


def _dead(sides: FloatArray, side: int) -> tuple[str, float, int, int] | None:
    """A channel that shows noise alone where the other wheel's moves."""
    own, other = sides[side], sides[1 - side]
    if np.isnan(own).any() or np.isnan(other).any():
        return None
    if 2.0 * np.ptp(own) > np.ptp(other):
        return None
    noise = white_sd(own[None, :])
    alive = np.ptp(other) > ALIVE * max(noise, white_sd(other[None, :]))
    if alive and np.ptp(own) < DEAD_SDS * noise:
        return "dead", float(np.median(own)), 0, own.size
    return None


def _finding(record: RigRecord, channel: str, fault: tuple[str, float, int, int]) -> RecordFinding:
    kind, value, first, length = fault
    words = {
        "dead": f"{channel} stays at {value:g} in the whole record while the rig moves",
        "stuck": f"{channel} stays at {value:g} for {length} samples from sample {first + 1} on while "
        "all moves",
        "clipped": f"{channel} is cut off at {value:g} for {length} samples from sample {first + 1}",
    }
    cures = {
        "dead": "check sensor and cable and record it again, or name it in absent",
        "stuck": "check the sensor and record it again",
        "clipped": "raise the measuring range and record it again",
    }
    severe = "error" if kind == "dead" or length > 0.05 * record.input.size else "warning"
    return RecordFinding(kind, severe, record.case.id, channel, record.label, words[kind], cures[kind])  # type: ignore[arg-type]
