"""Single samples that no wheel can have followed: found by a running median, replaced by their neighbours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.noise import white_sd

MEDIAN_SAMPLES = 7
"""Of the running median: sees up to three outliers in a row, and follows any monotone curve with its
kinks."""
OUTLIER_SDS = 12.0
"""Standard deviations of the channel's white noise from which a sample is one: it moves a reduced point, the
weighted mean of about a dozen samples, by one."""
RANGE_FLOOR = 1e-4
"""Share of the channel's range below which nothing is one: for records without noise."""
TURNING_STEPS = 8.0
"""Steps from sample to sample granted next to a turning point of the input, where the median lags."""
LARGEST = 1e12
"""Beyond it a number is no reading: marks of gaps, damaged cells."""


@dataclass(frozen=True)
class Outlier:
    """role: `input`, `toe_L`, ... sample: counted from 0. value: as read. neighbours: in its place."""

    role: str
    sample: int
    value: float
    neighbours: float


def without_outliers(
    values: Mapping[str, FloatArray], input_role: str
) -> tuple[dict[str, FloatArray], tuple[Outlier, ...]]:
    """Channels (n,) by role with single outliers replaced by interpolation, and the list of them.

    The input is cleaned first: where it turns, its channels do.
    """
    turning = near_turning(_cleaned(values[input_role], None)[0])
    out: dict[str, FloatArray] = {}
    removed: list[Outlier] = []
    for role, channel in values.items():
        clean, at = _cleaned(channel, turning)
        out[role] = clean
        removed += [Outlier(role, int(i), float(channel[i]), float(clean[i])) for i in at]
    return out, tuple(removed)


def near_turning(values: FloatArray) -> NDArray[np.bool_]:
    """(n,) samples within the median's window of a turning point of a smooth input."""
    smooth = running_median(values)
    way = np.sign(smooth[2:] - smooth[:-2])
    turns = np.flatnonzero(way[:-1] * way[1:] <= 0) + 1
    out = np.zeros(values.size, dtype=bool)
    for shift in range(-MEDIAN_SAMPLES, MEDIAN_SAMPLES + 1):
        out[np.clip(turns + shift, 0, values.size - 1)] = True
    return out


def running_median(values: FloatArray) -> FloatArray:
    """(n,) median over `MEDIAN_SAMPLES`, the ends continued by reflection about their own value."""
    half = MEDIAN_SAMPLES // 2
    padded = np.pad(values, half, mode="reflect", reflect_type="odd")
    return np.asarray(np.median(sliding_window_view(padded, MEDIAN_SAMPLES), axis=1))


def _cleaned(values: FloatArray, turning: NDArray[np.bool_] | None) -> tuple[FloatArray, NDArray[np.intp]]:
    if values.size <= 2 * MEDIAN_SAMPLES:
        return values, np.array([], dtype=np.intp)
    bounded = np.clip(values, -LARGEST, LARGEST)
    smooth = running_median(bounded)
    steps = np.abs(np.diff(smooth))
    low, high = np.quantile(smooth, (0.05, 0.95))
    level = np.full(values.size, OUTLIER_SDS * max(_sd(bounded), RANGE_FLOOR * float(high - low)))
    lag = TURNING_STEPS * float(np.quantile(steps, 0.9))
    level[slice(None) if turning is None else turning] += lag
    at = np.flatnonzero(np.abs(bounded - smooth) > level)
    if not at.size:
        return values, at
    clean = values.copy()
    kept = np.setdiff1d(np.arange(values.size), at)
    clean[at] = np.interp(at, kept, values[kept])
    return clean, at


def _sd(values: FloatArray) -> float:
    return white_sd(values[None, :])
