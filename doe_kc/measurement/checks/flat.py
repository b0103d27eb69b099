"""Dead, stuck and clipped channels: stretches of one and the same number while the rig moves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from doe_kc.curves import TYRE_LOAD
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.checks._base import RecordFinding, RigTest, Severity, channel_name, rig_check
from doe_kc.measurement.records import RigRecord

LONGEST = 8
"""Equal neighbouring samples that noise and resolution may bring about."""
USUAL_TIMES = 3.0
"""Times the length that 99 % of a channel's own equal stretches have: coarse resolution makes them long."""
MOVED = 0.03
"""Share of the input's range that passes meanwhile: not a dwell."""
ALIVE, DEAD_SDS = 18.0, 8.5
"""Standard deviations of noise that the range of a channel exceeds which shows something, and of one that
shows noise alone does not (6.5 expected of 512 samples)."""
POWERS, FOLLOWS_CHANCE = 3, 1e-3
"""Powers of the input that a channel which shows something follows, beside the input's direction, and the
chance below which it is not noise that follows them. A sound wheel may move little: toe of 0.004 deg, one
standard deviation of noise, in braking, where the other wheel on a softer bushing moved 0.06, followed its
input with a chance of 1e-11; a loop of 0.005 deg without a slope did in a lateral load case."""
DIRECTION_SHARE = 1 / 32
"""Of the record: over which the input's direction is taken, so that its noise does not count."""


@dataclass(frozen=True)
class _Flat:
    """kind: of fault. words: what the channel does. length: samples that it does so for."""

    kind: Literal["dead", "stuck", "clipped"]
    words: str
    value: float
    length: int


CURES = {
    "dead": "check sensor and cable and record it again, or name it in absent",
    "stuck": "check the sensor and record it again",
    "clipped": "raise the measuring range and record it again",
}


@rig_check
def flat(test: RigTest) -> Iterator[RecordFinding]:
    """Of every channel of every record, the input's too."""
    for runs in test.runs.values():
        records = [run.record for run in runs]
        for record in records:
            yield from _stretches(record)
        yield from _noise(records)


def _stretches(record: RigRecord) -> Iterator[RecordFinding]:
    for response, sides in record.channels.items():
        for side, values in enumerate(sides):
            fault = _stretch(values, record.input)
            if fault is not None and not (response == TYRE_LOAD and fault.value == 0.0):
                yield _finding(record, channel_name(response, side), fault)
    moving = record.channels["wc_z"] if "wc_z" in record.channels else next(iter(record.channels.values()))
    fault = _stretch(record.input, np.nan_to_num(moving[0]))
    if fault is not None and fault.kind != "clipped":
        yield _finding(record, record.case.channel, fault)


def _noise(records: Sequence[RigRecord]) -> Iterator[RecordFinding]:
    """Channels that show noise alone where the other wheel's moves, in records of one load case: those in
    which one has the range of noise are taken together."""
    for response in dict.fromkeys(name for record in records for name in record.channels):
        for side in (0, 1):
            silent = [r for r in records if response in r.channels and _silent(r, response, side)]
            moving = [r for r in silent if _alive(r, response, side)]
            if not moving or _follow([(r.channels[response][side], r.input) for r in silent]):
                continue
            for record in moving:
                values = record.channels[response][side]
                value = float(np.median(values))
                words = f"shows noise alone about {value:g} in the whole record while the other wheel's moves"
                fault = _Flat("dead", words, value, values.size)
                yield _finding(record, channel_name(response, side), fault)


def _stretch(values: FloatArray, other: FloatArray) -> _Flat | None:
    """The longest stretch of one number during which `other` moves."""
    if np.isnan(values).any() or np.count_nonzero(np.diff(values) == 0.0) < LONGEST:
        return None
    if np.ptp(values) == 0.0:
        value = float(values[0])
        words = f"stays at {value:g} in the whole record while the rig moves"
        return _Flat("dead", words, value, values.size)
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
    value, place = float(values[first]), f"for {length} samples from sample {first + 1}"
    if value in (float(values.max()), float(values.min())):
        return _Flat("clipped", f"is cut off at {value:g} {place}", value, length)
    return _Flat("stuck", f"stays at {value:g} {place} on while all moves", value, length)


def _silent(record: RigRecord, response: str, side: int) -> bool:
    """Whether a channel has the range of noise."""
    values = record.channels[response][side]
    return not np.isnan(values).any() and bool(np.ptp(values) < DEAD_SDS * record.white[response][side])


def _alive(record: RigRecord, response: str, side: int) -> bool:
    """Whether the other wheel's channel shows something, beside what is the range of one's noise."""
    sides, noise = record.channels[response], record.white[response].max()
    return bool(np.ptp(sides[1 - side]) > max(2.0 * np.ptp(sides[side]), ALIVE * noise))


def _follow(runs: Sequence[tuple[FloatArray, FloatArray]]) -> bool:
    """Whether a channel moves with powers of the input and its direction beyond what noise does, by the F
    test. runs: values and input of each."""
    from scipy.special import fdtrc

    columns = np.concatenate([_shapes(driven) for _, driven in runs])
    values = np.concatenate([own - own.mean() for own, _ in runs])
    left = values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]
    count = columns.shape[1]
    freedom = values.size - len(runs) - count
    ratio = (values @ values / (left @ left) - 1.0) * freedom / count
    return bool(fdtrc(count, freedom, ratio) < FOLLOWS_CHANCE)


def _shapes(driven: FloatArray) -> FloatArray:
    """(n, POWERS + 1) powers of an input (n,) and its direction, about their means."""
    powers = np.vander(driven / (np.abs(driven).max() or 1.0), POWERS + 1)[:, :-1]
    apart, at = max(1, round(DIRECTION_SHARE * driven.size)), np.arange(driven.size)
    ahead, behind = np.minimum(at + apart, driven.size - 1), np.maximum(at - apart, 0)
    columns = np.column_stack([powers, np.sign(driven[ahead] - driven[behind])])
    return np.asarray(columns - columns.mean(axis=0))


def _finding(record: RigRecord, channel: str, fault: _Flat) -> RecordFinding:
    severe = fault.kind == "dead" or fault.length > 0.05 * record.input.size
    words = f"{channel} {fault.words}"
    severity: Severity = "error" if severe else "warning"
    return RecordFinding(
        fault.kind, severity, record.case.id, channel, record.label, words, CURES[fault.kind]
    )
