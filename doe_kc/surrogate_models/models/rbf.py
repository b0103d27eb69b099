"""`rbf`: Gaussian radial functions with a polynomial tail, by SMT's RBF."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, LeftOut, SurrogateModel
from doe_kc.surrogate_models.models._base import register
from doe_kc.surrogate_models.ordinary_kriging import correlation
from doe_kc.surrogate_models.smt_library import RadialFit, train_rbf
from doe_kc.surrogate_models.training import Scaling

WIDTHS = (1.0, 2.0, 4.0)
"""Candidates for the width, in typical distances sqrt(d / 6) of two random points of the unit cube."""
TAIL_ROWS = 1.2
"""Rows for a linear tail, times its number of terms."""


@final
@register
@dataclass(frozen=True)
class RadialBasis(SurrogateModel):
    """One width for all outputs, chosen by leave-one-out; a linear tail once rows suffice, else a constant.

    The variance is the mean square of the left-out residuals, the same everywhere.
    width: in place of the choice, unit of x.
    """

    width: float | None = None

    id: ClassVar[str] = "rbf"
    label: ClassVar[str] = "Radial basis (SMT)"
    complexity: ClassVar[int] = 2
    interpolates: ClassVar[bool] = True
    exact_folds: ClassVar[bool] = True

    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> FittedRadialBasis:
        del seed
        typical = np.sqrt(x.shape[1] / 6.0)
        widths = [typical * w for w in WIDTHS] if self.width is None else [self.width]
        scale = Scaling.of(y)
        fits = [_fitted(x, scale.standardise(y), scale, float(w)) for w in widths]
        errors = [float(np.square(f.cross_validate().residual / scale.scale).mean()) for f in fits]
        return fits[int(np.argmin(errors))]


def _fitted(x: FloatArray, y: FloatArray, scale: Scaling, width: float) -> FittedRadialBasis:
    tail = len(x) >= TAIL_ROWS * (x.shape[1] + 1)
    fit = train_rbf(x, y, width=width, linear_tail=tail)
    return FittedRadialBasis(x, width, tail, scale, fit, _left_out(fit, len(x)))


def _left_out(fit: RadialFit, rows: int) -> FloatArray:
    """(n, m) residuals with the width held. Reference: S. Rippa, Adv. Comput. Math. 11, 1999."""
    diagonal = np.diag(np.linalg.inv(fit.matrix))[:rows]
    return np.asarray(fit.solution[:rows] / diagonal[:, None])


@final
@dataclass(frozen=True)
class FittedRadialBasis(Fitted):
    """x: (n, d) rows. left_out: (n, m) residuals of the standardised outputs."""

    x: FloatArray
    width: float
    linear_tail: bool
    scaling: Scaling
    fit: RadialFit
    left_out: FloatArray

    @property
    def variables(self) -> int:
        """d."""
        return int(self.x.shape[1])

    @property
    def outputs(self) -> int:
        """m."""
        return len(self.scaling.scale)

    def of(self, outputs: np.ndarray) -> FittedRadialBasis:
        """See `Fitted.of`."""
        fit = RadialFit(self.fit.matrix, self.fit.solution[:, outputs])
        scaling = self.scaling.chosen(outputs)
        return replace(self, scaling=scaling, fit=fit, left_out=self.left_out[:, outputs])

    def cross_validate(self) -> LeftOut:
        """Leave-one-out with the width held, closed form."""
        residual = self.left_out * self.scaling.scale
        return LeftOut(residual, np.tile((residual**2).mean(axis=0), (len(residual), 1)))

    def _radial(self, x: FloatArray) -> FloatArray:
        return np.asarray(correlation(np.full((1, self.variables), self.width**-2), x, self.x)[0])

    def _mean(self, x: FloatArray) -> FloatArray:
        n = len(self.x)
        tail = np.column_stack([np.ones(len(x)), x]) if self.linear_tail else np.ones((len(x), 1))
        standard = self._radial(x) @ self.fit.solution[:n] + tail @ self.fit.solution[n:]
        return self.scaling.shift + self.scaling.scale * standard

    def _gradient(self, x: FloatArray) -> FloatArray:
        n, r = len(self.x), self._radial(x)
        by = r[:, None] * self.fit.solution[:n].T[None]
        slope = -2.0 / self.width**2 * (by.sum(axis=2)[:, :, None] * x[:, None] - by @ self.x)
        if self.linear_tail:
            slope = slope + self.fit.solution[n + 1 :].T
        return np.asarray(self.scaling.scale[:, None] * slope)

    def _variance(self, x: FloatArray) -> FloatArray:
        return np.tile((self.left_out**2).mean(axis=0) * self.scaling.scale**2, (len(x), 1))

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        return np.zeros((len(x), self.outputs, self.variables))
