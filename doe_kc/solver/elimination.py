"""An order of elimination for the Jacobians of many designs of one topology, chosen for one of them.

Each pivot is the entry of least fill among those that are not small in their column (Markowitz' rule with
threshold pivoting). Other designs are eliminated in the same order, which their lanes have in common.
Reference: I. S. Duff, A. M. Erisman, J. K. Reid, Direct Methods for Sparse Matrices, Oxford, 2017, chapter 7.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.kernel import Kernel, kernel

PIVOT_THRESHOLD = 0.1
"""Least pivot over the largest entry of its column: other designs may differ by as much without harm."""


@dataclass(frozen=True)
class EliminationOrder:
    """row_of, column_of: (m,) equation and unknown of each pivot. Numbers of L by column, U by row and the
    diagonal stand one after the other; place: (nnz,) of the Jacobian's numbers there, -1 for those of none.

    l_start, u_start: (m + 1,) first entry of each pivot; l_row, u_column: pivots that entries belong to.
    target: place of every product of the elimination, in its order.
    """

    row_of: np.ndarray
    column_of: np.ndarray
    l_start: np.ndarray
    l_row: np.ndarray
    u_start: np.ndarray
    u_column: np.ndarray
    place: np.ndarray
    target: np.ndarray

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """In the order of `march_batch`."""
        return (
            *(self.row_of, self.column_of, self.l_start, self.l_row),
            *(self.u_start, self.u_column, self.place, self.target),
        )


def elimination_order(kernel: Kernel, nonzeros: FloatArray, active: int) -> EliminationOrder:
    """Of the first `active` equations and unknowns; nonzeros: (nnz,) of a design's Jacobian.

    LinAlgError where that design's matrix is singular.
    """
    keep = (kernel.rows < active) & (kernel.cols < active)
    rows, columns = kernel.rows[keep], kernel.cols[keep]
    matrix = np.zeros((active, active))
    matrix[rows, columns] = nonzeros[keep] / kernel.scale[rows]
    pattern = np.zeros((active, active), dtype=bool)
    pattern[rows, columns] = True
    row_of, column_of = _pivots(matrix, pattern)
    return _of_pivots(kernel, keep, pattern, row_of, column_of)


def paired_order(kernel: Kernel, nonzeros: FloatArray, active: int) -> EliminationOrder:
    """The same in a tenth of the time: pairs by `minimum_degree_order`, each put off until its pivot is not
    small. LinAlgError as `elimination_order`, which takes over where pairs lead to no end."""
    keep = (kernel.rows < active) & (kernel.cols < active)
    rows, columns = kernel.rows[keep], kernel.cols[keep]
    place = np.argsort(kernel.layout.order[:active])
    matrix = np.zeros((active, active))
    matrix[place[rows], place[columns]] = nonzeros[keep] / kernel.scale[rows]
    left = np.arange(active)  # the pairs of the rows and columns
    for k in range(active):
        i = _first_pivot(matrix, k)
        if i is None:
            return elimination_order(kernel, nonzeros, active)
        if i != k:
            moved = np.r_[i, k:i]
            left[k : i + 1] = left[moved]
            matrix[k : i + 1] = matrix[moved]
            matrix[:, k : i + 1] = matrix[:, moved]
        below = matrix[k + 1 :, k] / matrix[k, k]
        matrix[k + 1 :, k + 1 :] -= np.outer(below, matrix[k, k + 1 :])
    pairs = kernel.layout.order[left]
    return _of_pairs(kernel.topology, active, pairs.tobytes())


def _first_pivot(matrix: FloatArray, k: int) -> int | None:
    """The first place from k on whose pivot is not small in what is left of its column."""
    for i in range(k, len(matrix)):
        if abs(matrix[i, i]) > PIVOT_THRESHOLD * np.abs(matrix[k:, i]).max():
            return i
    return None


@lru_cache(maxsize=2 * TOPOLOGY_CACHE)
def _of_pairs(topology: Topology, active: int, pairs: bytes) -> EliminationOrder:
    """pairs: (active,) equations and unknowns of the same number."""
    k, order = kernel(topology), np.frombuffer(pairs, dtype=np.int32)
    keep = (k.rows < active) & (k.cols < active)
    pattern = np.zeros((active, active), dtype=bool)
    pattern[k.rows[keep], k.cols[keep]] = True
    for place, pair in enumerate(order):
        pattern[pair, pair] = True
        left = order[place + 1 :]
        pattern[np.ix_(left, left)] |= np.outer(pattern[left, pair], pattern[pair, left])
    return _of_pivots(k, keep, pattern, order, order)


def _of_pivots(
    kernel: Kernel, keep: np.ndarray, pattern: np.ndarray, row_of: np.ndarray, column_of: np.ndarray
) -> EliminationOrder:
    """keep: (nnz,) the Jacobian's numbers that are eliminated; pattern: (m, m) filled by the elimination."""
    rows, columns = kernel.rows[keep], kernel.cols[keep]
    active = len(pattern)
    filled = pattern[np.ix_(row_of, column_of)]
    l_start, l_row = _starts(np.tril(filled, -1).T)
    u_start, u_column = _starts(np.triu(filled, 1))
    entries = _entries(filled, l_start, l_row, u_start, u_column)
    place = np.full(len(keep), -1)
    place[keep] = entries[np.argsort(row_of)[rows], np.argsort(column_of)[columns]]
    target = [
        entries[np.ix_(l_row[l_start[k] : l_start[k + 1]], u_column[u_start[k] : u_start[k + 1]])].ravel()
        for k in range(active)
    ]
    whole = (row_of, column_of, l_start, l_row, u_start, u_column, place, np.concatenate(target))
    return EliminationOrder(*(np.ascontiguousarray(array, dtype=np.int32) for array in whole))


def _pivots(matrix: FloatArray, pattern: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns in the order of elimination; `pattern` is filled as the elimination fills it."""
    m = len(matrix)
    rows, columns = np.arange(m), np.arange(m)  # those that are left come last
    for k in range(m):
        left = np.ix_(rows[k:], columns[k:])
        size, there = np.abs(matrix[left]), pattern[left]
        largest = size.max(axis=0)
        if not (np.isfinite(largest).all() and largest.max() > 0.0):
            raise np.linalg.LinAlgError("singular design: it gives no order of elimination")
        fill = np.outer(there.sum(axis=1) - 1, there.sum(axis=0) - 1).astype(float)
        share = size / np.where(largest > 0.0, largest, 1.0)
        fill[~there | (share < PIVOT_THRESHOLD)] = np.inf
        least = np.where(fill == fill.min(), share, -1.0)
        i, j = divmod(int(np.argmax(least)), least.shape[1])
        rows[[k, k + i]], columns[[k, k + j]] = rows[[k + i, k]], columns[[k + j, k]]
        below, right, pivot = rows[k + 1 :], columns[k + 1 :], (rows[k], columns[k])
        factors = matrix[below, pivot[1]] / matrix[pivot]
        matrix[np.ix_(below, right)] -= np.outer(factors, matrix[pivot[0], right])
        pattern[np.ix_(below, right)] |= np.outer(pattern[below, pivot[1]], pattern[pivot[0], right])
    return rows, columns


def _starts(pattern: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where each row's entries start, and their columns."""
    ends = np.cumsum(pattern.sum(axis=1))
    return np.concatenate([[0], ends]), np.nonzero(pattern)[1]


def _entries(
    filled: np.ndarray, l_start: np.ndarray, l_row: np.ndarray, u_start: np.ndarray, u_column: np.ndarray
) -> np.ndarray:
    """(m, m) place of each entry among the numbers of L, U and the diagonal."""
    m = len(filled)
    entries = np.full((m, m), -1)
    pivots = np.arange(m)
    entries[l_row, np.repeat(pivots, np.diff(l_start))] = np.arange(len(l_row))
    entries[np.repeat(pivots, np.diff(u_start)), u_column] = len(l_row) + np.arange(len(u_column))
    entries[pivots, pivots] = len(l_row) + len(u_column) + pivots
    return entries
