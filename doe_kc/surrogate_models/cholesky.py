"""Factors of many positive definite matrices, by LAPACK without copies."""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray

INDISTINCT = "surrogate: designs are nearly equal and cannot be told apart; spread them or leave one out."


def inverses(matrices: FloatArray) -> FloatArray:
    """(m, n, n) inverses; RunError for a matrix that is not positive definite."""
    half = matrices.copy()
    for matrix in half:
        lapack.dpotri(_factor(matrix), lower=1, overwrite_c=1)
    upper = np.triu(half, 1)
    both = upper + upper.transpose(0, 2, 1)
    diagonal = np.arange(matrices.shape[1])
    both[:, diagonal, diagonal] = half[:, diagonal, diagonal]
    return both


def inverse_roots(matrices: FloatArray) -> FloatArray:
    """(m, n, n) inverses of the lower Cholesky factors; RunError as `inverses`."""
    half = matrices.copy()
    for matrix in half:
        lapack.dtrtri(_factor(matrix), lower=1, overwrite_c=1)
    return np.ascontiguousarray(np.triu(half).transpose(0, 2, 1))


def _factor(matrix: FloatArray) -> FloatArray:
    """Lower factor of a C-ordered matrix in its place: the transposed view is what LAPACK wants."""
    factor, failed = lapack.dpotrf(matrix.T, lower=1, overwrite_a=1)
    if failed:
        raise RunError(INDISTINCT)
    return np.asarray(factor)
