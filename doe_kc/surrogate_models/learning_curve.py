"""How the error falls with the number of designs, and how many a given Q2 asks for.

e(N) = e(n) (n / N)^b of each output, e = sqrt(1 - Q2): e(n) from the cross-validation, b from a second one
that leaves half the designs out.
Reference: C. Cortes et al., Advances in Neural Information Processing Systems 6, 1994 (power law).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from doe_kc.campaign.executors import processes
from doe_kc.campaign.processes import available_cores
from doe_kc.ground.errors import DoeKcError
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.calibration import DEPENDENCE
from doe_kc.surrogate_models.folds import fold, fold_rows
from doe_kc.surrogate_models.interface import SurrogateModel
from doe_kc.surrogate_models.validation import NOMINAL_WIDTH

HALVES = 2
LEAST_RATE, MOST_RATE = 0.25, 2.5
"""Between which a rate is believed: noise falls with 0.5, a smooth function faster."""
OWN_SHARE = 0.5
"""Belief in an output's own rate beside the median of all: two errors of the same few designs tell little."""
CURVE_REACH = 20.0
"""Times the designs up to which the curve is followed."""


@dataclass(frozen=True)
class LearningCurve:
    """Of m outputs. sizes: designs that the half and the whole cross-validation learn from. errors: (2, m)
    sqrt(1 - Q2) there, nan for an output that does not vary. rate: (m,) b. spread: standard deviation of
    the rates.
    """

    sizes: tuple[float, float]
    errors: FloatArray
    rate: FloatArray
    spread: float

    def error(self, designs: float) -> FloatArray:
        """(m,) sqrt(1 - Q2) that so many designs give."""
        return np.asarray(self.errors[1] * (self.sizes[1] / designs) ** self.rate)

    def needed(self, q2: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(m,) designs for a Q2: best guess, lower and upper 95 % limit; half to `CURVE_REACH` times.

        ln N is as uncertain as the error's logarithm over b, and its distance from ln n as b is.
        """
        with np.errstate(divide="ignore"):
            gap = np.log(self.errors[1] / np.sqrt(1.0 - q2)) / self.rate
        error = DEPENDENCE / np.sqrt(2.0 * self.sizes[1]) / self.rate
        off = NOMINAL_WIDTH * np.hypot(error, gap * self.spread / self.rate)
        ends = np.log(self.sizes[0] / self.sizes[1]), np.log(CURVE_REACH)
        low, best, high = (self.sizes[1] * np.exp(np.clip(g, *ends)) for g in (gap - off, gap, gap + off))
        return best, low, high


def learning_curve(
    models: Mapping[str, SurrogateModel],
    chosen: Sequence[str],
    x: FloatArray,
    y: FloatArray,
    *,
    q2: FloatArray,
    folds: int,
    seed: int,
    workers: int | None = None,
) -> LearningCurve | None:
    """Of the chosen model of each output. models: by name. q2: (m,) of the cross-validation with `folds`.

    None where half the designs are too few for one of the models.
    """
    used = list(dict.fromkeys(chosen))
    rows = fold_rows(len(x), HALVES, seed)
    tasks = [partial(_half, models[name], x, y, left, seed) for name in used for left in rows]
    parts = _results(tasks, workers)
    squares = np.zeros(y.shape[1])
    for k, name in enumerate(used):
        for part in parts[HALVES * k : HALVES * (k + 1)]:
            if part is None:
                return None
            mine = np.array([c == name for c in chosen])
            squares[mine] += np.square(part).sum(axis=0)[mine]
    total = np.square(y - y.mean(axis=0)).sum(axis=0)
    varies = np.isfinite(q2)
    half = np.sqrt(np.where(varies, np.maximum(squares / np.where(varies, total, 1.0), 1e-12), np.nan))
    whole = np.sqrt(np.where(varies, np.maximum(1.0 - q2, 1e-12), np.nan))
    sizes = (len(x) / HALVES, len(x) * (1.0 - 1.0 / min(folds, len(x))))
    own = np.clip(np.log(half / whole) / np.log(sizes[1] / sizes[0]), LEAST_RATE, MOST_RATE)
    median = float(np.nanmedian(own)) if varies.any() else 1.0
    rate = np.where(varies, OWN_SHARE * own + (1.0 - OWN_SHARE) * median, median)
    spread = OWN_SHARE * float(np.nanstd(own)) if varies.any() else 0.0
    return LearningCurve(sizes, np.array([half, whole]), rate, spread)


_Task = Callable[[], FloatArray | None]


def _half(
    model: SurrogateModel, x: FloatArray, y: FloatArray, left: np.ndarray, seed: int
) -> FloatArray | None:
    try:
        return fold(model, x, y, left, seed)[0]
    except DoeKcError:
        return None


def _results(tasks: Sequence[_Task], workers: int | None) -> list[FloatArray | None]:
    count = min(workers or available_cores(), len(tasks))
    if count <= 1:
        return [task() for task in tasks]
    with processes(count) as executor:
        return [future.result() for future in [executor.submit(task) for task in tasks]]
