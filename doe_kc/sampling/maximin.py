"""Latin hypercubes whose points keep apart: exchanges within columns under the criterion phi_p.

phi_p = (sum over pairs d^-p)^(1/p), p = 10, small where the smallest distances are large. Exchanging two
entries of a column keeps the hypercube Latin; the best of several exchanges is taken, also a slightly worse
one while the threshold is high (enhanced stochastic evolutionary algorithm, with the row that is closest to
others in every second trial).
References: R. Jin, W. Chen, A. Sudjianto, J. Statistical Planning and Inference 134(1), 2005; M. D. Morris,
T. J. Mitchell, ibid. 43(3), 1995.
"""

from __future__ import annotations

import numpy as np

from doe_kc.ground.typing import FloatArray

HALF_POWER = 5
"""p / 2: distances are kept squared."""
TRIALS = 40
"""Exchanges that each step chooses from."""
STEPS_A_COLUMN = 60
MOST_EXCHANGES = 12_000
FIRST_THRESHOLD, LAST_THRESHOLD = 3e-4, 1e-7
"""Relative growth of the sum that a step may make, at the first and at the last step."""
LEAST_SQUARE = 1e-12
"""Squared distance that stands for a row's distance to itself and for equal rows."""


def spread_hypercube(points: FloatArray, rng: np.random.Generator, *, fixed: int = 0) -> FloatArray:
    """The points (n, d) of the unit cube with the entries of each column exchanged so that they keep apart.

    fixed: first rows that stay as they are. Equal for equal generators.
    """
    n, d = points.shape
    if n - fixed < 2 or d < 2:
        return points.copy()
    search = _Search(points.copy(), fixed, rng)
    steps = min(MOST_EXCHANGES, STEPS_A_COLUMN * max(d, n))
    best, least = search.x.copy(), search.total
    for threshold in np.geomspace(FIRST_THRESHOLD, LAST_THRESHOLD, steps):
        search.step(threshold)
        if search.total < least:
            best, least = search.x.copy(), search.total
    return best


class _Search:
    """x: (n, d). inverse: (n, n) squared distances to the power -p / 2, zero on the diagonal. total: their
    sum, each pair once."""

    def __init__(self, x: FloatArray, fixed: int, rng: np.random.Generator) -> None:
        self.x, self.fixed, self.rng = x, fixed, rng
        norm = (x**2).sum(axis=1)
        self.square = np.maximum(norm[:, None] + norm - 2.0 * x @ x.T, LEAST_SQUARE)
        self.inverse = self.square**-HALF_POWER
        np.fill_diagonal(self.inverse, 0.0)
        self.total = float(self.inverse.sum()) / 2.0
        self.focus = False

    def step(self, threshold: float) -> None:
        """The best of some exchanges of one row within one column, if it is good enough."""
        n, rng = len(self.x), self.rng
        column = self.x[:, rng.integers(self.x.shape[1])]
        self.focus = not self.focus
        row = self._crowded() if self.focus else int(rng.integers(self.fixed, n))
        others = rng.integers(self.fixed, n, TRIALS)
        others = others[others != row]
        if not len(others):
            return
        own = (column - column[row]) ** 2
        theirs = (column - column[others][:, None]) ** 2
        mine, yours = self.square[row] - own + theirs, self.square[others] - theirs + own
        a, b = _powers(mine), _powers(yours)
        places = np.arange(len(others))
        for powers in (a, b):
            powers[places, others] = 0.0
            powers[:, row] = 0.0
        change = (a + b).sum(axis=1) - self.inverse[row].sum() - self.inverse[others].sum(axis=1)
        change += 2.0 * self.inverse[row, others]
        k = int(np.argmin(change))
        if change[k] <= threshold * self.total:
            self._exchange(column, row, int(others[k]), mine[k], yours[k], float(change[k]))

    def _crowded(self) -> int:
        """The movable row of the largest sum."""
        return self.fixed + int(np.argmax(self.inverse[self.fixed :].sum(axis=1)))

    def _exchange(
        self, column: FloatArray, row: int, other: int, mine: FloatArray, yours: FloatArray, change: float
    ) -> None:
        between = self.square[row, other]
        column[row], column[other] = column[other], column[row]
        for place, squares in ((row, mine), (other, yours)):
            squares[[row, other]] = between
            squares[place] = LEAST_SQUARE
            powers = _powers(squares)
            powers[place] = 0.0
            self.square[place] = self.square[:, place] = np.maximum(squares, LEAST_SQUARE)
            self.inverse[place] = self.inverse[:, place] = powers
        self.total += change


def _powers(squares: FloatArray) -> FloatArray:
    """Squared distances to the power -p / 2."""
    inverse = 1.0 / np.maximum(squares, LEAST_SQUARE)
    twice = inverse * inverse
    return np.asarray(twice * twice * inverse)


def more_slices(points: FloatArray, more: int, rng: np.random.Generator) -> FloatArray:
    """(more, d) places in slices of the grown hypercube that none of the points (n, d) is in, at random.

    With n + more slices a variable, points that were a hypercube of n hit at most n of them.
    """
    total = len(points) + more
    columns = []
    for column in points.T:
        taken = np.unique(np.clip((column * total).astype(int), 0, total - 1))
        empty = np.setdiff1d(np.arange(total), taken)
        places = np.round(np.linspace(0, len(empty) - 1, more)).astype(int)
        columns.append((rng.permutation(empty[places]) + rng.random(more)) / total)
    return np.stack(columns, axis=1)
