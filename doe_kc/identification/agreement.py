"""How far two influence matrices agree: correlation of a column's entries, signed and of their magnitudes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class MatrixAgreement:
    """All (m,), one entry a column; nan where a column has fewer than two cells or does not vary.

    magnitude: correlation coefficient of the magnitudes. signed: that of the signed entries, times `sign`.
    sign: +1, or -1 where a column agrees but for its overall sign. cells: that were compared.
    """

    magnitude: FloatArray
    signed: FloatArray
    sign: np.ndarray
    cells: np.ndarray

    @property
    def means(self) -> tuple[float, float]:
        """Of magnitude and signed, over the columns that have one."""
        return float(np.nanmean(self.magnitude)), float(np.nanmean(self.signed))


def agreement(
    own: FloatArray, measured: FloatArray, counted: np.ndarray, *, any_sign: bool
) -> MatrixAgreement:
    """Of (p, m) matrices over the cells counted (p, m) that both have.

    any_sign: whether an overall sign of a column is free, as between load cases of other conventions.
    """
    both = counted & np.isfinite(own) & np.isfinite(measured)
    pairs = [(own[rows, j], measured[rows, j]) for j, rows in enumerate(both.T)]
    signed = np.array([correlation(a, b) for a, b in pairs])
    sign = np.where(any_sign & (signed < 0), -1, 1)
    magnitude = np.array([correlation(np.abs(a), np.abs(b)) for a, b in pairs])
    return MatrixAgreement(magnitude, signed * sign, sign, both.sum(axis=0))


def correlation(a: FloatArray, b: FloatArray) -> float:
    """Pearson's coefficient; nan of fewer than two entries or of constant ones."""
    if a.size < 2 or np.ptp(a) == 0.0 or np.ptp(b) == 0.0:
        return float("nan")
    return float(np.corrcoef(a, b)[0, 1])
