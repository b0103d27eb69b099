"""Surrogate: fast models of the characteristics, as an estimator of scikit-learn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.exceptions import NotFittedError

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.style import PALETTE
from doe_kc.surrogate_models.models import make
from doe_kc.surrogate_models.study import SurrogateStudy, fit_study
from doe_kc.variables import Space

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


class Surrogate(RegressorMixin, BaseEstimator):  # type: ignore[misc] # scikit-learn ships no types
    """Surrogates of every output, cross-validated, the best kind chosen for each; an estimator of
    scikit-learn (`clone`, `cross_val_score`, `Pipeline`).

    models: ids of the kinds to choose from ("linear", "quadratic", "rbf", "gp", "gp_ard", "kpls",
    "kriging"), by default those that suit the number of designs. space: of a study (`study.space`,
    `sampling.space`), whose bounds and logarithmic scales map each variable to [0, 1]; by default the
    smallest and largest value of each column. folds: of the cross-validation of kinds that learn many
    hyper-parameters, by default ten, five from 150 designs on. seed: of the kinds that use chance. workers:
    processes of the fit.

    After `fit`: study_, every kind with its cross-validation; feature_names_in_, the columns of X;
    output_names_, those of y; lower_, upper_, (d,) in real units, beyond which a prediction extrapolates.

    >>> sampling = kc.sample("examples/front_axle", 24, workers=1)
    >>> model = kc.Surrogate(models=["linear"], space=sampling.space)
    >>> model = model.fit(sampling.designs, sampling.responses)
    >>> mean, sd = model.predict(sampling.designs.iloc[:2], return_std=True)
    >>> mean.shape == sd.shape == (2, sampling.responses.shape[1])
    True
    """

    def __init__(
        self,
        models: Sequence[str] = (),
        *,
        space: Space | None = None,
        folds: int | None = None,
        seed: int = 0,
        workers: int | None = 1,
    ) -> None:
        self.models = models
        self.space = space
        self.folds = folds
        self.seed = seed
        self.workers = workers

    def fit(self, X: Any, y: Any) -> Surrogate:
        """Fit every kind, cross-validate, choose one for each output.

        X: (n, d) designs in real units, a DataFrame with parameter paths as columns or an array (with
        `space`: its variables in their order). y: (n, m) or (n,) outputs, DataFrame, Series or array.

        Raises InputError for columns that `space` does not have or that never change, numbers that are not
        finite, equal designs, sizes that do not match, or fewer than 10 designs.
        """
        for name in self.models:
            make(name, "Surrogate: models")
        points, names = self._designs(X)
        values, outputs, form = _outputs(y)
        if len(points) != len(values):
            raise InputError(
                f"Surrogate: {len(points)} designs but {len(values)} rows of y; give one row each."
            )
        _check_finite(points, names, "X")
        self._set_bounds(points, names)
        study = fit_study(
            self._unit(points),
            values,
            models=self.models,
            folds=self.folds,
            seed=self.seed,
            workers=self.workers,
        )
        return self._fitted(names, outputs, form, study)

    def _fitted(self, names: list[str], outputs: list[Any], form: str, study: SurrogateStudy) -> Surrogate:
        self.feature_names_in_, self.n_features_in_ = np.array(names, dtype=object), len(names)
        self.output_names_, self._form = outputs, form
        self.study_, self._model = study, study.model
        return self

    def predict(self, X: Any, return_std: bool = False) -> Any:
        """Mean of every output at the designs X, in the output's unit; shaped and labelled as the y of `fit`.

        return_std: also the calibrated standard deviation of the prediction, shaped alike. The columns of a
        DataFrame may be in any order, others beside them are left aside.

        Raises NotFittedError before `fit`; InputError for missing columns or numbers that are not finite.
        """
        if not hasattr(self, "study_"):
            raise NotFittedError("Surrogate: call fit before predict.")
        points = self._points(X)
        unit = self._unit(points)
        mean = self._shaped(self._model.predict(unit), X)
        if not return_std:
            return mean
        return mean, self._shaped(np.sqrt(self._model.variance(unit)), X)

    def to_frame(self) -> pd.DataFrame:
        """One row an output: model (its kind), q2 (cross-validated, 1 = perfect, 0 = no better than the
        mean), rmse (unit of the output), coverage of the 95 % interval after calibration."""
        import pandas as pd

        self._check_fitted()
        done = self.study_

        def chosen(value: str) -> FloatArray:
            return done.of_chosen({k: getattr(j.quality, value) for k, j in done.models.items()})

        return pd.DataFrame(
            {
                "model": done.chosen,
                "q2": chosen("q2"),
                "rmse": chosen("rmse"),
                "coverage": done.of_chosen({k: j.covered for k, j in done.models.items()}),
            },
            index=pd.Index(self.output_names_, name="output"),
        )

    def plot(self, output: str | None = None, ax: Axes | None = None) -> Axes:
        """Left-out predictions over true values of one output, by default the first; InputError for an
        unknown one."""
        from doe_kc.api.axes import axes_or_new

        self._check_fitted()
        name = self.output_names_[0] if output is None else output
        if name not in self.output_names_:
            raise InputError(
                f"Surrogate: no output {name!r}.{nearest(str(name), map(str, self.output_names_))}"
            )
        j, done = self.output_names_.index(name), self.study_
        true = done.y[:, j]
        predicted = true - done.models[done.chosen[j]].held.residual[:, j]
        ax = axes_or_new(ax, (4.8, 4.6))
        ends = [min(true.min(), predicted.min()), max(true.max(), predicted.max())]
        ax.plot(ends, ends, color="black", lw=0.8)
        ax.plot(true, predicted, "o", ms=3, color=PALETTE["blue"], alpha=0.7)
        entry = CHARACTERISTICS.get(str(name))
        unit = "" if entry is None else f" [{entry.unit}]"
        ax.set_xlabel(f"true solver{unit}")
        ax.set_ylabel(f"surrogate, the design left out{unit}")
        ax.set_title(f"{name}: {done.chosen[j]}, Q² {self.to_frame()['q2'].iloc[j]:.4f}", fontsize="medium")
        ax.grid(color="#DDDDDD", lw=0.5)
        return ax

    def _check_fitted(self) -> None:
        if not hasattr(self, "study_"):
            raise NotFittedError("Surrogate: call fit first.")

    def _designs(self, X: Any) -> tuple[FloatArray, list[str]]:
        """(n, d) numbers and the names of their columns, of the designs to fit."""
        columns = list(X.columns) if hasattr(X, "columns") else None
        if self.space is None:
            points = _matrix(X, "X")
            return points, [f"x{j + 1}" for j in range(points.shape[1])] if columns is None else columns
        names = list(self.space.paths)
        if columns is not None:
            others = sorted(set(map(str, columns)) - set(names))
            if others:
                raise InputError(
                    f"Surrogate: X has the column {others[0]!r}, no variable of the space; leave it out."
                )
            return _columns(X, names), names
        points = _matrix(X, "X")
        if points.shape[1] != len(names):
            raise InputError(
                f"Surrogate: X of {points.shape[1]} columns, the space has {len(names)} variables."
            )
        return points, names

    def _points(self, X: Any) -> FloatArray:
        """(p, d) numbers of designs to predict."""
        names = list(self.feature_names_in_)
        points = _columns(X, names) if hasattr(X, "columns") else _matrix(X, "X")
        if points.shape[1] != len(names):
            raise InputError(f"Surrogate: X of {points.shape[1]} columns, fitted with {len(names)}.")
        _check_finite(points, names, "X")
        return points

    def _set_bounds(self, points: FloatArray, names: list[str]) -> None:
        if self.space is not None:
            self.lower_ = np.array([v.lower for v in self.space.variables])
            self.upper_ = np.array([v.upper for v in self.space.variables])
            return
        self.lower_, self.upper_ = points.min(axis=0), points.max(axis=0)
        fixed = np.flatnonzero(self.upper_ == self.lower_)
        if fixed.size:
            raise InputError(f"Surrogate: column {names[fixed[0]]!r} of X never changes; leave it out.")

    def _unit(self, points: FloatArray) -> FloatArray:
        """(p, d) places between the bounds, [0, 1] inside them."""
        if self.space is None:
            return np.asarray((points - self.lower_) / (self.upper_ - self.lower_))
        columns = []
        for variable, column in zip(self.space.variables, points.T, strict=True):
            if variable.logarithmic and column.min(initial=np.inf) <= 0.0:
                raise InputError(f"Surrogate: {variable.path} = {column.min():g}, expected a number > 0.")
            columns.append([variable.place(float(value)) for value in column])
        return np.array(columns).T.reshape(points.shape)

    def _shaped(self, values: FloatArray, X: Any) -> Any:
        """(p, m) as y was: DataFrame, Series, (p,) or (p, m)."""
        if self._form == "vector":
            return values[:, 0]
        if self._form == "matrix":
            return values
        import pandas as pd

        index = X.index if hasattr(X, "index") else None
        if self._form == "series":
            return pd.Series(values[:, 0], index=index, name=self.output_names_[0])
        return pd.DataFrame(values, index=index, columns=self.output_names_)


def fitted_surrogate(surrogate: Surrogate, outputs: list[str], study: SurrogateStudy) -> Surrogate:
    """The estimator, which has a space, with fits of that space's unit cube that were made before.

    outputs: names of the (n, m) outputs; predictions come as DataFrames.
    """
    assert surrogate.space is not None
    names = list(surrogate.space.paths)
    surrogate._set_bounds(study.x, names)
    return surrogate._fitted(names, outputs, "frame", study)


def _matrix(a: Any, what: str) -> FloatArray:
    try:
        matrix = np.array(a, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(f"Surrogate: {what} holds what is no number ({error}).") from None
    if matrix.ndim != 2:
        raise InputError(f"Surrogate: {what} of shape {matrix.shape}, expected one row a design.")
    return matrix


def _columns(frame: Any, names: list[str]) -> FloatArray:
    known = list(frame.columns)
    for name in names:
        if name not in known:
            raise InputError(f"Surrogate: X has no column {name!r}.{nearest(str(name), map(str, known))}")
    return _matrix(frame[names], "X")


def _check_finite(points: FloatArray, names: list[str], what: str) -> None:
    rows, columns = np.nonzero(~np.isfinite(points))
    if rows.size:
        raise InputError(
            f"Surrogate: row {rows[0] + 1} of {what}, column {names[columns[0]]!r}: is not a finite "
            "number; leave failed designs out."
        )


def _outputs(y: Any) -> tuple[FloatArray, list[Any], str]:
    """(n, m) numbers, their names, and the form to return predictions in."""
    if hasattr(y, "columns"):
        return _matrix(y, "y"), list(y.columns), "frame"
    if hasattr(y, "to_frame"):
        return _matrix(y.to_frame(), "y"), [y.name], "series"
    array = np.asarray(y)
    if array.ndim == 1:
        return _matrix(array[:, None], "y"), ["y1"], "vector"
    values = _matrix(array, "y")
    return values, [f"y{j + 1}" for j in range(values.shape[1])], "matrix"
