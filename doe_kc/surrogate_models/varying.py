"""Outputs that never change: kept as the constants they are, beside the model of the others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted, LeftOut, SurrogateModel
from doe_kc.surrogate_models.training import constant_outputs


def fit_varying(model: SurrogateModel, x: FloatArray, y: FloatArray, *, seed: int = 0) -> Fitted:
    """`model.fit` of the outputs that change; constant ones predict their value with variance zero.

    InputError as `SurrogateModel.fit`, and when no output changes at all.
    """
    values = np.asarray(y, dtype=float)
    fixed = constant_outputs(values) if values.ndim == 2 and len(values) else np.zeros(0, dtype=bool)
    if not fixed.any():
        return model.fit(x, y, seed=seed)
    if fixed.all():
        raise InputError(f"surrogate {model.id}: no output changes over the designs; vary other parameters.")
    return Varying(
        model.of(~fixed).fit(x, values[:, ~fixed], seed=seed), np.flatnonzero(~fixed), values.mean(axis=0)
    )


@final
@dataclass(frozen=True)
class Varying(Fitted):
    """inner: model of the outputs `places` (k,), of one that none asks for where k is 0; constant: (m,)
    values of all outputs, used of the others."""

    inner: Fitted
    places: np.ndarray
    constant: FloatArray

    @property
    def variables(self) -> int:
        """d."""
        return self.inner.variables

    @property
    def outputs(self) -> int:
        """m."""
        return len(self.constant)

    def of(self, outputs: np.ndarray) -> Varying:
        """See `Fitted.of`."""
        where = {int(place): k for k, place in enumerate(self.places)}
        kept = [where[int(j)] for j in outputs if int(j) in where]
        places = np.array([i for i, j in enumerate(outputs) if int(j) in where], dtype=int)
        return Varying(self.inner.of(np.array(kept or [0])), places, self.constant[outputs])

    def cross_validate(self) -> LeftOut:
        """Of the inner model; zero for the constants."""
        held = self.inner.cross_validate()
        return LeftOut(self._spread(held.residual), self._spread(held.variance))

    def _spread(self, values: FloatArray) -> FloatArray:
        """(p, m, ...) of (p, k, ...): zero for the constants."""
        out = np.zeros((len(values), self.outputs, *values.shape[2:]))
        out[:, self.places] = values[:, : self.places.size]
        return out

    def _mean(self, x: FloatArray) -> FloatArray:
        out = np.tile(self.constant, (len(x), 1))
        out[:, self.places] = self.inner.predict(x)[:, : self.places.size]
        return out

    def _variance(self, x: FloatArray) -> FloatArray:
        return self._spread(self.inner.variance(x))

    def _gradient(self, x: FloatArray) -> FloatArray:
        return self._spread(self.inner.gradient(x))

    def _variance_gradient(self, x: FloatArray) -> FloatArray:
        return self._spread(self.inner.variance_gradient(x))
