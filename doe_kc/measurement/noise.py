"""What a rig's repeat runs say about its errors, as standard deviations and covariance matrices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from doe_kc.curves import TYRE_LOAD
from doe_kc.ground.typing import FloatArray

Source = Literal["repeats", "resolution"]
_ORDER = 4
"""Of the differences: they annul the cubic that a smooth curve is between five neighbouring samples."""
_BINOMIAL_NORM = 70.0**0.5
"""sqrt(1 + 16 + 36 + 16 + 1): sd of a fourth difference of unit white noise."""
_MAD_TO_SD = 1.4826
"""1 / Phi^-1(3/4): the median absolute value of a normal variable to its standard deviation."""
_KEPT = 0.95
"""Share of the smallest differences that count where more than half vanish."""


def white_sd(samples: FloatArray) -> float:
    """sd of the white noise in the last axis of `samples` (k, n), n >= 5, all rows together, in their unit.

    Fourth differences annul any cubic; their median absolute value does not see turning points and
    kinks. When more than half of them vanish (coarse quantisation): rms of the smallest 95 %.
    Source: Gasser, Sroka & Jennen-Steinmetz, Biometrika 73 (1986) 625, with order 4 and a robust scale.
    """
    return float(_robust_sds(_differences(samples).reshape(1, -1))[0])


def white_sds(samples: FloatArray) -> FloatArray:
    """(k,) sd of the white noise in each row of `samples` (k, n), as `white_sd`."""
    return _robust_sds(_differences(samples))


def _differences(samples: FloatArray) -> FloatArray:
    return np.asarray(np.diff(samples, n=_ORDER, axis=-1) / _BINOMIAL_NORM)


def _robust_sds(differences: FloatArray) -> FloatArray:
    """(k,) of differences (k, m) of unit weight."""
    sizes = np.abs(differences)
    out = _MAD_TO_SD * np.median(sizes, axis=1)
    for k in np.flatnonzero(out <= 0.0):
        kept = np.sort(sizes[k])[: int(_KEPT * sizes.shape[1])]
        out[k] = np.sqrt(np.mean(kept**2))
    return np.asarray(out)


def pooled_white_sd(runs: Sequence[FloatArray]) -> float:
    """rms of `white_sd` over runs."""
    return float(np.sqrt(np.mean([white_sd(run) ** 2 for run in runs])))


@dataclass(frozen=True)
class ErrorComponents:
    """Standard deviations of one sensor kind from run to run, pooled over load cases and sides.

    offset: constant over a run, in the sensor's unit. gain: proportional to the change from static, -.
    smooth: slowly varying remainder, in the sensor's unit, with squared-exponential correlation
    exp(-d²/2l²). length: its l as a fraction of the load case's amplitude.
    dof: degrees of freedom behind offset and gain; 0 when `source` is "resolution" (one run only).
    """

    offset: float
    gain: float
    smooth: float
    length: float
    dof: int
    source: Source


@dataclass(frozen=True)
class NoiseModel:
    """Errors of one load case and response (both sides alike).

    white: sample-to-sample sd of the channel. input_white: of the input channel, in `input`'s unit;
        it adds |slope| times itself to the response. loop: run-to-run sd of the half-width curve
        beyond white noise. components: run-to-run sd of the curve.
    input: (n,) grid. gram: (n, n) white-noise covariance of one run's mean curve per unit variance.
    slope: (2, n) response per input. signal: (2, n) change from static that the gain multiplies.
    runs: number of runs averaged; of the mean of several cars, the number that would be as sure.
    """

    load_case: str
    response: str
    white: float
    input_white: float
    loop: float
    components: ErrorComponents
    input: FloatArray
    gram: FloatArray
    slope: FloatArray
    signal: FloatArray
    runs: float

    def run_covariance(self, side: int) -> FloatArray:
        """(n, n) covariance of one run's mean curve with its static value still in it."""
        c = self.components
        relative = self.input / np.abs(self.input).max()
        level = self._sample_sd(side)
        return (
            self.gram * np.outer(level, level)
            + c.offset**2
            + c.gain**2 * np.outer(self.signal[side], self.signal[side])
            + c.smooth**2 * smooth_correlation(relative, c.length)
        )

    def covariance(
        self, input_grid: FloatArray | None = None, *, side: int = 0, runs: float | None = None
    ) -> FloatArray:
        """(m, m) covariance of the mean curve of `runs` runs (default: those averaged), unit squared.

        Angles and positions are changes from static: the value at input 0 is taken off, so the offset
        cancels and row and column of input 0 are zero. `input_grid`: (m,) inside the range,
        default the own.
        """
        total = self.run_covariance(side) / (runs or self.runs)
        if self.response != TYRE_LOAD:
            total = _referred(total, int(np.argmin(np.abs(self.input))))
        if input_grid is None:
            return total
        weights = interpolation_matrix(self.input, input_grid)
        return weights @ total @ weights.T

    def point_sd(self, side: int) -> FloatArray:
        """(n,) white noise of each point of the averaged mean or half-width curve."""
        return np.asarray(self._sample_sd(side) * np.sqrt(np.diag(self.gram) / self.runs))

    def _sample_sd(self, side: int) -> FloatArray:
        return np.asarray(np.sqrt(self.white**2 + (self.slope[side] * self.input_white) ** 2))

    def half_width_covariance(self, *, side: int = 0, runs: float | None = None) -> FloatArray:
        """(n, n) covariance of the averaged half-width curve: white noise and the loop's own scatter."""
        level = self._sample_sd(side)
        relative = self.input / np.abs(self.input).max()
        wander = self.loop**2 * smooth_correlation(relative, self.components.length)
        out: FloatArray = (self.gram * np.outer(level, level) + wander) / (runs or self.runs)
        return out


CaseNoise = Mapping[str, NoiseModel]
"""Response -> noise model of one load case."""


def smooth_correlation(relative: FloatArray, length: float) -> FloatArray:
    """(n, n) squared-exponential correlation over inputs given as fractions of the amplitude."""
    distance = (relative[:, None] - relative[None, :]) / length
    out: FloatArray = np.exp(-0.5 * distance**2)
    return out


def interpolation_matrix(grid: FloatArray, wanted: FloatArray) -> FloatArray:
    """(m, n) linear interpolation from `grid` to `wanted`."""
    return np.stack([np.interp(wanted, grid, row) for row in np.eye(grid.size)], axis=1)


def _referred(covariance: FloatArray, at: int) -> FloatArray:
    """T C T' with T = I - 1 e_at': covariance after the value at index `at` is subtracted."""
    shifted = covariance - covariance[at : at + 1, :]
    out: FloatArray = shifted - shifted[:, at : at + 1]
    return out
