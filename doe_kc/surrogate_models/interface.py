"""What every surrogate can do: fit points of the unit cube, predict with variance and gradients."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.training import check_points, check_training


@dataclass(frozen=True)
class Prediction:
    """p points, m outputs, d variables. mean, variance: (p, m); gradient, variance_gradient: (p, m, d)."""

    mean: FloatArray
    variance: FloatArray
    gradient: FloatArray
    variance_gradient: FloatArray


@dataclass(frozen=True)
class LeftOut:
    """What models say of n training rows that they were not fitted to.

    residual: (n, m) true minus predicted. variance: (n, m) predicted for it.
    """

    residual: FloatArray
    variance: FloatArray


class Fitted(ABC):
    """A trained surrogate of m outputs over d variables; x is (p, d) in [0, 1], beyond it an extrapolation.

    InputError for points of another dimension. Deterministic; holds no reference to the caller's arrays.
    """

    @property
    @abstractmethod
    def variables(self) -> int:
        """d."""

    @property
    @abstractmethod
    def outputs(self) -> int:
        """m."""

    @property
    def chunk(self) -> int:
        """Points that are predicted at once, for the memory's sake."""
        return 1000

    @final
    def predict(self, x: FloatArray) -> FloatArray:
        """(p, m) mean, unit of each output."""
        return self._in_chunks(self._mean, x)

    @final
    def variance(self, x: FloatArray) -> FloatArray:
        """(p, m) variance of the prediction, unit of each output squared, >= 0."""
        return self._in_chunks(self._variance, x)

    @final
    def gradient(self, x: FloatArray) -> FloatArray:
        """(p, m, d) d mean / d x, exact."""
        return self._in_chunks(self._gradient, x)

    @final
    def variance_gradient(self, x: FloatArray) -> FloatArray:
        """(p, m, d) d variance / d x, exact."""
        return self._in_chunks(self._variance_gradient, x)

    @final
    def predict_all(self, x: FloatArray) -> Prediction:
        """Mean, variance and both gradients at once."""
        points = check_points(x, self.variables)
        with one_thread():
            return self._everything(points)

    @abstractmethod
    def of(self, outputs: np.ndarray) -> Fitted:
        """The same predictions of some outputs alone, places (k,) with k > 0; what the others take is left
        out."""

    @abstractmethod
    def cross_validate(self) -> LeftOut:
        """Left-out residuals of the training rows: leave-one-out in closed form, or folds (see the model)."""

    @abstractmethod
    def _mean(self, x: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _variance(self, x: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _gradient(self, x: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _variance_gradient(self, x: FloatArray) -> FloatArray: ...

    def _everything(self, x: FloatArray) -> Prediction:
        """Models that share work between mean, variance and gradients override this."""
        return Prediction(self._mean(x), self._variance(x), self._gradient(x), self._variance_gradient(x))

    @final
    def _in_chunks(self, evaluate: Callable[[FloatArray], FloatArray], x: FloatArray) -> FloatArray:
        points, size = check_points(x, self.variables), max(1, self.chunk)
        with one_thread():
            if len(points) <= size:
                return evaluate(points)
            return np.concatenate([evaluate(points[i : i + size]) for i in range(0, len(points), size)])


class SurrogateModel(ABC):
    """A kind of surrogate with its options; one instance fits any number of data sets.

    id: name in studies and tables. label: name in figures. complexity: order among the models, 0 = simplest.
    costly: takes longer than it is worth beside the others, so it is used on request only. interpolates:
    passes through the training values. exact_folds: `cross_validate` is leave-one-out in closed form with the
    model's hyper-parameters held. optimistic_loo: it learns so many of those that its left-out residuals come
    out too small, and only refitting tells how good it is.
    uses_slopes: it is fitted about an exact first-order expansion, and cannot do without one.
    """

    id: ClassVar[str]
    label: ClassVar[str]
    complexity: ClassVar[int]
    costly: ClassVar[bool] = False
    interpolates: ClassVar[bool]
    exact_folds: ClassVar[bool]
    optimistic_loo: ClassVar[bool] = False
    uses_slopes: ClassVar[bool] = False

    def fewest(self, variables: int) -> int:
        """Rows below which the model cannot be fitted."""
        del variables
        return 5

    def worthwhile(self, rows: int, variables: int) -> bool:
        """Whether it is tried by default with so many of them: it can be fitted, and is worth its time beside
        the others."""
        return not self.costly and rows >= self.fewest(variables)

    def of(self, outputs: np.ndarray) -> SurrogateModel:
        """The model for the outputs marked (m,): itself, unless it knows something of each."""
        del outputs
        return self

    @final
    def fit(self, x: FloatArray, y: FloatArray, *, seed: int = 0) -> Fitted:
        """Model of x (n, d) in the unit cube and y (n, m).

        InputError for rows that are not finite or equal, too few rows, outputs that never change, or sizes
        that do not match. The arguments are copied. seed: of the models that use chance.
        """
        needed = self.fewest(np.shape(x)[-1] if np.ndim(x) else 0)
        data_x, data_y = check_training(x, y, needed, self.id)
        with one_thread():
            return self._fit(data_x, data_y, seed)

    @abstractmethod
    def _fit(self, x: FloatArray, y: FloatArray, seed: int) -> Fitted: ...
