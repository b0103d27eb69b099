"""Cross-validation by refitting: what a model with all its choices makes of rows that it never saw."""

from __future__ import annotations

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import LeftOut, SurrogateModel
from doe_kc.surrogate_models.varying import fit_varying


def fold_rows(rows: int, folds: int, seed: int) -> list[np.ndarray]:
    """Row numbers of each fold, drawn at random: sizes differ by at most one."""
    order = np.random.default_rng(seed).permutation(rows)
    return [np.sort(order[k::folds]) for k in range(min(folds, rows))]


def refit_folds(model: SurrogateModel, x: FloatArray, y: FloatArray, *, folds: int, seed: int) -> LeftOut:
    """Residuals of rows predicted by a model refitted, hyper-parameters and all, to the other folds.

    Leaving rows out with hyper-parameters held flatters models that learn many of them (docs/surrogates.md).
    """
    residual, variance = np.empty_like(y), np.empty_like(y)
    for left in fold_rows(len(x), folds, seed):
        residual[left], variance[left] = fold(model, x, y, left, seed)
    return LeftOut(residual, variance)


def fold(
    model: SurrogateModel, x: FloatArray, y: FloatArray, left: np.ndarray, seed: int
) -> tuple[FloatArray, FloatArray]:
    """Residual and predicted variance of the rows `left`, from a fit to all others."""
    kept = np.setdiff1d(np.arange(len(x)), left)
    fitted = fit_varying(model, x[kept], y[kept], seed=seed)
    return y[left] - fitted.predict(x[left]), fitted.variance(x[left])
