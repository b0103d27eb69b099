"""Single samples that no wheel can have followed: found by a running median, replaced by their neighbours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.noise import white_sds

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
    clean_input = _replaced(values[input_role], _far(values[input_role][None, :], None)[0])
    roles, channels = list(values), np.array(list(values.values()))
    far = _far(channels, near_turning(clean_input))
    out = {role: _replaced(values[role], row) for role, row in zip(roles, far, strict=True)}
    removed = [
        Outlier(roles[k], int(i), float(values[roles[k]][i]), float(out[roles[k]][i]))
        for k, i in zip(*np.nonzero(far), strict=True)
    ]
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
    """(..., n) median over `MEDIAN_SAMPLES`, the ends continued by reflection about their own value."""
    half = MEDIAN_SAMPLES // 2
    ends = [(0, 0)] * (values.ndim - 1)
    padded = np.pad(values, [*ends, (half, half)], mode="reflect", reflect_type="odd")
    around = sliding_window_view(padded, MEDIAN_SAMPLES, axis=-1)
    return np.asarray(np.partition(around, half, axis=-1)[..., half])


def _far(channels: FloatArray, turning: NDArray[np.bool_] | None) -> NDArray[np.bool_]:
    """(k, n) whether a sample of the channels (k, n) is an outlier."""
    if channels.shape[1] <= 2 * MEDIAN_SAMPLES:
        return np.zeros(channels.shape, dtype=bool)
    bounded = np.clip(channels, -LARGEST, LARGEST)
    smooth = running_median(bounded)
    steps = np.abs(np.diff(smooth))
    low, high = np.quantile(smooth, (0.05, 0.95), axis=1)
    least = OUTLIER_SDS * np.maximum(white_sds(bounded), RANGE_FLOOR * (high - low))
    level = np.repeat(least[:, None], channels.shape[1], axis=1)
    lag = TURNING_STEPS * np.quantile(steps, 0.9, axis=1)
    level[:, slice(None) if turning is None else turning] += lag[:, None]
    return np.asarray(np.abs(bounded - smooth) > level)


def _replaced(channel: FloatArray, far: NDArray[np.bool_]) -> FloatArray:
    """(n,) the channel with interpolation in place of its outliers."""
    if not far.any():
        return channel
    clean = channel.copy()
    at = np.arange(channel.size)
    clean[far] = np.interp(at[far], at[~far], channel[~far])
    return clean
