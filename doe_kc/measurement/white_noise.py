"""Sample-to-sample noise of a sampled channel, whatever slow curve it carries."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from doe_kc.ground.typing import FloatArray

_ORDER = 4
_BINOMIAL_NORM = 70.0**0.5
"""sqrt(1 + 16 + 36 + 16 + 1): sd of a fourth difference of unit white noise."""
_MAD_TO_SD = 1.4826
_KEPT = 0.95


def white_sd(samples: FloatArray) -> float:
    """sd of the white noise in the last axis of `samples` (k, n), n >= 5, in their unit.

    Fourth differences annul any cubic; their median absolute value does not see turning points and
    kinks. When more than half of them vanish (coarse quantisation): rms of the smallest 95 %.
    Source: Gasser, Sroka & Jennen-Steinmetz, Biometrika 73 (1986) 625, with order 4 and a robust scale.
    """
    differences = np.diff(samples, n=_ORDER, axis=-1).ravel() / _BINOMIAL_NORM
    robust = _MAD_TO_SD * float(np.median(np.abs(differences)))
    if robust > 0.0:
        return robust
    kept = np.sort(np.abs(differences))[: int(_KEPT * differences.size)]
    return float(np.sqrt(np.mean(kept**2)))


def pooled_white_sd(runs: Sequence[FloatArray]) -> float:
    """rms of `white_sd` over runs."""
    return float(np.sqrt(np.mean([white_sd(run) ** 2 for run in runs])))
