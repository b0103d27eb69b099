"""An order of elimination from nothing but the places of a Jacobian's nonzeros: the same for every design.

Equation i and unknown i are eliminated together, of those that are left the pair with the fewest neighbours
(minimum degree). A pair without its own nonzero, as that of a rigid joint's force, waits until a neighbour's
elimination has filled the place. Small pivots are left to the elimination, which swaps rows there.
Reference: I. S. Duff, A. M. Erisman, J. K. Reid, Direct Methods for Sparse Matrices, Oxford, 2017,
chapters 7 and 8.
"""

from __future__ import annotations

import numpy as np


def minimum_degree_order(rows: np.ndarray, cols: np.ndarray, size: int, tail: int) -> np.ndarray:
    """(size,) pairs in the order of elimination, the last `tail` in the end as they are.

    rows, cols: (nnz,) places of the nonzeros.
    """
    head = size - tail
    pattern = np.zeros((size, size), dtype=bool)
    pattern[rows, cols] = True
    neighbours = (pattern | pattern.T)[:head, :head]
    ready, left = pattern.diagonal()[:head].copy(), np.ones(head, dtype=bool)
    np.fill_diagonal(neighbours, val=False)
    order = np.arange(size, dtype=np.int32)
    for k in range(head):
        candidates = left & ready if np.any(left & ready) else left
        degree = np.where(candidates, neighbours[:, left].sum(axis=1), size)
        pair = int(np.argmin(degree))
        left[pair] = False
        around = np.flatnonzero(neighbours[pair] & left)
        neighbours[np.ix_(around, around)] = True
        neighbours[around, around] = False
        ready[around] = True
        order[k] = pair
    return order
