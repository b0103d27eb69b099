"""A surrogate of whole answers: principal components of the designs, each a Gaussian process."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.live.answer_vector import AnswerVector
from doe_kc.surrogate_models.folds import fold, fold_rows
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.surrogate_models.models.gp import GaussianProcess
from doe_kc.surrogate_models.study import VALIDATION_DESIGNS
from doe_kc.surrogate_models.training import constant_outputs
from doe_kc.surrogate_models.varying import fit_varying

MOST_COMPONENTS = 40
LEFT_OUT_ENERGY = 1e-7
"""Share of the squared differences that the components left out may hold."""
LEFT_OUT_FOLDS = 5
NO_RANGE = 1e-9
"""Range of a curve below which it does not change."""


@dataclass(frozen=True)
class CurveSurrogate:
    """y(u) = middle + components' scores(u), (N,). scores: None where there is no more than the middle.

    components: (q, N). designs: that it was fitted to.
    """

    middle: FloatArray
    components: FloatArray
    scores: Fitted | None
    designs: int

    def at(self, point: FloatArray) -> FloatArray:
        """(N,) at a point (d,)."""
        if self.scores is None:
            return self.middle
        return np.asarray(self.middle + self.scores.predict(point[None])[0] @ self.components)

    def slopes(self, point: FloatArray) -> FloatArray:
        """(N, d) derivatives at a point (d,)."""
        if self.scores is None:
            return np.zeros((len(self.middle), len(point)))
        return np.asarray(self.components.T @ self.scores.gradient(point[None])[0])


@dataclass(frozen=True)
class LeftOutError:
    """Largest error of a mean curve of a design that was left out, as share of that curve's range over all
    designs: median of the designs, and of the worst; nan where nothing could be left out."""

    median: float
    worst: float


@one_thread()
def fit_curve_surrogate(points: FloatArray, rows: FloatArray, form: AnswerVector) -> CurveSurrogate:
    """points: (n, d). rows: (n, N). With fewer than ten designs, or equal ones, the mean of the rows."""
    middle = rows.mean(axis=0)
    axes, scale = _axes(rows - middle, form)
    scores = (rows - middle) / scale @ axes.T
    if len(rows) < VALIDATION_DESIGNS or not len(axes) or constant_outputs(scores).all():
        return CurveSurrogate(middle, np.zeros((0, len(middle))), None, len(rows))
    return CurveSurrogate(middle, axes * scale, fit_varying(GaussianProcess(), points, scores), len(rows))


def _axes(left: FloatArray, form: AnswerVector) -> tuple[FloatArray, FloatArray]:
    """(q, N) principal axes of the differences over their scale (N,), the largest of each curve."""
    scale = np.ones(left.shape[1])
    for block in form.blocks:
        scale[block.place] = max(float(np.abs(left[:, block.place]).max(initial=0.0)), NO_RANGE)
    end = form.blocks[-1].place.stop
    scale[end:] = np.maximum(np.abs(left[:, end:]).max(axis=0, initial=0.0), NO_RANGE)
    _, s, axes = np.linalg.svd(left / scale, full_matrices=False)
    rest = np.cumsum((s**2)[::-1])[::-1]
    kept = int(np.sum(rest > LEFT_OUT_ENERGY * max(float(rest[0]), NO_RANGE**2)))
    return np.asarray(axes[: min(kept, MOST_COMPONENTS)]), scale


@one_thread()
def left_out_error(
    points: FloatArray, rows: FloatArray, answers: FloatArray, form: AnswerVector
) -> LeftOutError:
    """By fitting anew without a fifth of the designs at a time; the mean without each of them where they are
    fewer than ten.

    rows: (n, N) that the surrogate is of. answers: (n, N) whole ones, whose ranges count.
    """
    n = len(rows)
    if n < 2:
        return LeftOutError(float("nan"), float("nan"))
    middle = rows.mean(axis=0)
    axes, scale = _axes(rows - middle, form)
    scores = (rows - middle) / scale @ axes.T
    varying = ~constant_outputs(scores)
    if n < VALIDATION_DESIGNS or not varying.any():
        missed = (rows - middle) * n / (n - 1)
    else:
        missed = np.zeros_like(rows)
        for left in fold_rows(n, LEFT_OUT_FOLDS, 0):
            errors, _ = fold(GaussianProcess(), points, scores[:, varying], left, 0)
            missed[left] = errors @ axes[varying] * scale
    shares = []
    for block in form.blocks:
        spread = float(np.ptp(answers[:, block.place]))
        if not block.half and spread > NO_RANGE:
            shares.append(np.abs(missed[:, block.place]).max(axis=1) / spread)
    worst = np.max(shares, axis=0)
    return LeftOutError(float(np.median(worst)), float(worst.max()))
