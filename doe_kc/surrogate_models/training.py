"""Checks of the data that a surrogate is fitted to, and the standardised form that models work in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray

CONSTANT = 1e-10
"""Range over largest magnitude below which an output counts as constant: solver round-off."""


def check_training(x: FloatArray, y: FloatArray, fewest: int, model: str) -> tuple[FloatArray, FloatArray]:
    """Copies of x (n, d) and y (n, m); InputError naming what is wrong and the remedy."""
    points, values = _matrix(x, "points"), _matrix(y, "values")
    if len(points) != len(values):
        raise InputError(
            f"surrogate {model}: {len(points)} points but {len(values)} rows of values; give one row each."
        )
    if len(points) < fewest:
        raise InputError(
            f"surrogate {model}: {len(points)} designs for {points.shape[1]} variables, needs at least "
            f"{fewest}; run more designs or choose another model."
        )
    _check_rows(points, values, model)
    fixed = np.flatnonzero(constant_outputs(values))
    if fixed.size:
        raise InputError(
            f"surrogate {model}: output {fixed[0] + 1} has the same value in every design; leave it out "
            "(fit_varying does)."
        )
    return points, values


def check_points(x: FloatArray, variables: int) -> FloatArray:
    """x as (p, variables) numbers; InputError otherwise."""
    points = _matrix(x, "points")
    if points.shape[1] != variables:
        raise InputError(f"surrogate: points of {points.shape[1]} variables, fitted with {variables}.")
    return points


def constant_outputs(y: FloatArray) -> np.ndarray:
    """(m,) bool: outputs that never change beyond round-off."""
    values = np.asarray(y, dtype=float)
    return np.asarray(np.ptp(values, axis=0) <= CONSTANT * np.maximum(np.abs(values).max(axis=0), CONSTANT))


def _matrix(a: FloatArray, what: str) -> FloatArray:
    matrix = np.array(a, dtype=float)
    if matrix.ndim != 2:
        raise InputError(f"surrogate: {what} of shape {matrix.shape}, expected one row a design.")
    return matrix


def _check_rows(x: FloatArray, y: FloatArray, model: str) -> None:
    bad = np.flatnonzero(~(np.isfinite(x).all(axis=1) & np.isfinite(y).all(axis=1)))
    if bad.size:
        raise InputError(
            f"surrogate {model}: {bad.size} of {len(x)} designs hold values that are not finite, the first "
            f"is row {bad[0] + 1}; leave failed designs out."
        )
    _, first = np.unique(x, axis=0, return_index=True)
    if first.size < len(x):
        again = np.setdiff1d(np.arange(len(x)), first)[0]
        raise InputError(f"surrogate {model}: design {again + 1} is there twice; keep one of the equal rows.")


@dataclass(frozen=True)
class Scaling:
    """shift, scale: (m,) so that (y - shift) / scale has mean 0 and standard deviation 1."""

    shift: FloatArray
    scale: FloatArray

    @classmethod
    def of(cls, y: FloatArray) -> Scaling:
        """Of training values (n, m) that change."""
        return cls(y.mean(axis=0), y.std(axis=0))

    def chosen(self, outputs: np.ndarray) -> Scaling:
        """Of some outputs: places (k,)."""
        return Scaling(self.shift[outputs], self.scale[outputs])

    def standardise(self, y: FloatArray) -> FloatArray:
        """(n, m) standardised values."""
        return np.asarray((y - self.shift) / self.scale)
