"""Calibration of the surrogates' predicted variances by the candidates confirmed so far."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from doe_kc.correlation.problem import Evaluated

MEMORY = 6
"""Last confirmations that count."""
LIMITS = (1e-3, 10.0)


class VarianceCalibration:
    """`factor`: of the predicted variances that the last confirmations ask for."""

    def __init__(self) -> None:
        self._ratios = [1.0]

    @property
    def factor(self) -> float:
        """Geometric mean of the squared errors over the predicted variances."""
        return float(np.clip(np.exp(np.mean(np.log(self._ratios[-MEMORY:]))), *LIMITS))

    def learn(self, answers: Iterable[Evaluated]) -> None:
        """From answers to candidates whose standard deviations carried the present factor."""
        factor = self.factor
        self._ratios.extend(r for a in answers if (r := _squared_error(a, factor)) is not None)


def _squared_error(answer: Evaluated, factor: float) -> float | None:
    predicted = answer.candidate.predicted
    if answer.score is None or predicted is None:
        return None
    doubted = predicted.sd > 0.0  # the others never change, or are predicted to round-off
    if not doubted.any():
        return None
    z = (answer.score.values - predicted.values)[doubted] / predicted.sd[doubted]
    return max(factor * float(np.mean(z**2)), 1e-6)
