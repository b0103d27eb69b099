"""`quadratic`: linear, pure and interaction terms, the few that matter found by the lasso."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.folds import fold_rows
from doe_kc.surrogate_models.interface import Fitted, LeftOut, SurrogateModel
from doe_kc.surrogate_models.legendre import Terms, all_terms, feature_slopes, features, jacobian
from doe_kc.surrogate_models.models._base import register
from doe_kc.surrogate_models.ridge import FittedLinear, fit_ridge
from doe_kc.surrogate_models.scikit_library import PenaltyPath, lasso_path

QUADRATIC_PENALTIES = np.logspace(0.0, -3.0, 25)
"""Candidates, as share of the smallest penalty that leaves no term."""
PENALTY_FOLDS = 5
"""Usual (Breiman, Spector, Int. Stat. Rev. 60, 1992: five to ten)."""


@final
@register
@dataclass(frozen=True)
class Quadratic(SurrogateModel):
    """Per output: terms of the lasso at the penalty that five folds like best, refitted by ridge regression.

    At most half as many terms as rows. `cross_validate` gives the residuals of those folds.
    """

    id: ClassVar[str] = "quadratic"
    label: ClassVar[str] = "Quadratic (lasso)"
    complexity: ClassVar[int] = 1
    costly: ClassVar[bool] = True
    interpolates: ClassVar[bool] = False
    exact_folds: ClassVar[bool] = False

    def fewest(self, variables: int) -> int:
        """Ten rows, whatever the number of variables."""
        del variables
        return 10

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> FittedQuadratic:
        terms = all_terms(x.shape[1])
        basis = features(terms, x)
        folds = fold_rows(len(x), PENALTY_FOLDS, seed)
        parts = [_fit_one(terms, basis, column, folds) for column in y.T]
        return FittedQuadratic(x.shape[1], tuple(parts))


@dataclass(frozen=True)
class Polynomial:
    """One output: terms, the ridge regression on their values, left_out (n,) residuals of the folds."""

    terms: Terms
    ridge: FittedLinear
    left_out: FloatArray

    @property
    def slack(self) -> float:
        """Mean square of the left-out residuals over the variance that the ridge regression, its terms held,
        predicts for them."""
        return float((self.left_out**2).mean() / self.ridge.cross_validate().variance.mean())


def _fit_one(terms: Terms, basis: FloatArray, y: FloatArray, folds: list[np.ndarray]) -> Polynomial:
    centred = basis - basis.mean(axis=0)
    highest = float(np.abs(centred.T @ (y - y.mean())).max()) / len(y)
    penalties = highest * QUADRATIC_PENALTIES
    kept = [np.setdiff1d(np.arange(len(y)), left) for left in folds]
    paths = [_path(basis[rows], y[rows], penalties[-1]) for rows in kept]
    best = penalties[int(np.argmin(_errors(paths, basis, y, folds, kept, penalties)))]
    left_out = np.empty_like(y)
    for left, rows, path in zip(folds, kept, paths, strict=True):
        active, ridge = _refit(path, basis[rows], y[rows], best)
        left_out[left] = y[left] - ridge.predict(basis[left][:, active])[:, 0]
    active, ridge = _refit(_path(basis, y, best), basis, y, best)
    return Polynomial(terms.chosen(active), ridge, left_out)


def _path(basis: FloatArray, y: FloatArray, least: float) -> PenaltyPath:
    return lasso_path(basis, y, least=least, steps=max(3, len(y) // 2))


def _errors(
    paths: list[PenaltyPath], basis: FloatArray, y: FloatArray, folds: list[np.ndarray],
    kept: list[np.ndarray], penalties: FloatArray,
) -> FloatArray:  # fmt: skip
    """(k,) squared errors of the lasso itself over all folds at each penalty."""
    total = np.zeros(len(penalties))
    for left, rows, path in zip(folds, kept, paths, strict=True):
        coefficients = np.column_stack([path.at(float(p)) for p in penalties])
        level = y[rows].mean() - basis[rows].mean(axis=0) @ coefficients
        total += ((y[left][:, None] - level - basis[left] @ coefficients) ** 2).sum(axis=0)
    return total


def _refit(
    path: PenaltyPath, basis: FloatArray, y: FloatArray, penalty: float
) -> tuple[np.ndarray, FittedLinear]:
    """Places of the terms that the path keeps at the penalty, at least one, and their ridge regression."""
    coefficients = path.at(penalty)
    if not coefficients.any():
        coefficients = path.coefficients[:, min(1, path.coefficients.shape[1] - 1)]
    active = np.flatnonzero(coefficients) if coefficients.any() else np.array([0])
    ridge = fit_ridge(basis[:, active], y[:, None])
    return active, ridge


@final
@dataclass(frozen=True)
class FittedQuadratic(Fitted):
    """dimension: d. parts: one polynomial an output."""

    dimension: int
    parts: tuple[Polynomial, ...]

    @property
    def variables(self) -> int:
        """d."""
        return self.dimension

    @property
    def outputs(self) -> int:
        """m."""
        return len(self.parts)

    def of(self, outputs: np.ndarray) -> FittedQuadratic:
        """See `Fitted.of`."""
        return FittedQuadratic(self.dimension, tuple(self.parts[int(j)] for j in outputs))

    def cross_validate(self) -> LeftOut:
        """Five folds, the terms chosen anew in each at the same penalty."""
        residual = np.column_stack([p.left_out for p in self.parts])
        variance = [p.slack * p.ridge.cross_validate().variance[:, 0] for p in self.parts]
        return LeftOut(residual, np.column_stack(variance))

    def _mean(self, x: FloatArray) -> FloatArray:
        return np.column_stack([p.ridge.predict(features(p.terms, x))[:, 0] for p in self.parts])

    def _gradient(self, x: FloatArray) -> FloatArray:
        slopes = [feature_slopes(p.terms, x, p.ridge.slope[0]) for p in self.parts]
        return np.stack(slopes, axis=1)

    def _variance(self, x: FloatArray) -> FloatArray:
        columns = [p.slack * p.ridge.variance(features(p.terms, x))[:, 0] for p in self.parts]
        return np.column_stack(columns)

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        return np.stack([_variance_slope(p, x) for p in self.parts], axis=1)


def _variance_slope(part: Polynomial, x: FloatArray) -> FloatArray:
    """(p, d) by the chain rule over the terms."""
    by_term = part.ridge.variance_gradient(features(part.terms, x))[:, 0]
    return np.asarray(part.slack * np.einsum("pt,ptd->pd", by_term, jacobian(part.terms, x), optimize=True))
