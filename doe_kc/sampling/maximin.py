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
LEAST_SQUARE = 1e-7
"""Squared distance that stands for smaller ones and a row's to itself; its power fits single precision."""


def spread_hypercube(points: FloatArray, rng: np.random.Generator, *, fixed: int = 0) -> FloatArray:
    """The points (n, d) of the unit cube with the entries of each column exchanged so that they keep apart.

    fixed: first rows that stay as they are. Equal for equal generators.
    """
    n, d = points.shape
    if n - fixed < 2 or d < 2:
        return points.copy()
    search = _Search(points.copy(), fixed, rng)
    steps = min(MOST_EXCHANGES, STEPS_A_COLUMN * max(d, n))
    for threshold in np.geomspace(FIRST_THRESHOLD, LAST_THRESHOLD, steps):
        search.step(threshold)
    return search.best


class _Search:
    """x: (n, d). square: (n, n) squared distances; inverse: their power -p / 2, zero on the diagonal;
    both in single precision, which tells trials apart at half the time.

    rows: (n,) sums of inverse by row, kept up to date as rows change; total: the sum of each pair once.
    """

    def __init__(self, x: FloatArray, fixed: int, rng: np.random.Generator) -> None:
        self.x, self.fixed, self.rng = x, fixed, rng
        norm = (x**2).sum(axis=1)
        square = np.maximum(norm[:, None] + norm - 2.0 * x @ x.T, LEAST_SQUARE)
        inverse = square**-HALF_POWER
        np.fill_diagonal(inverse, 0.0)
        self.rows = inverse.sum(axis=1)
        self.total = float(self.rows.sum()) / 2.0
        self.square, self.inverse = square.astype(np.float32), inverse.astype(np.float32)
        self.focus = False
        self._least, self._best = self.total, self.x.copy()
        # large arrays that are made anew at every step would cost more than what is computed in them
        self._buffers = np.empty((6, TRIALS, len(x)), dtype=np.float32)

    def step(self, threshold: float) -> None:
        """The best of some exchanges of one row within one column, if it is good enough."""
        n, rng = len(self.x), self.rng
        column = self.x[:, rng.integers(self.x.shape[1])]
        self.focus = not self.focus
        row = self._crowded() if self.focus else int(rng.integers(self.fixed, n))
        others = rng.integers(self.fixed, n, TRIALS)
        others = others[others != row]
        if len(others):
            k = int(np.argmin(self._changes(column.astype(np.float32), row, others)))
            self._try_exchange(column, row, int(others[k]), threshold)

    @property
    def best(self) -> FloatArray:
        """The points of the least total so far."""
        return self.x.copy() if self.total < self._least else self._best

    def _crowded(self) -> int:
        """The movable row of the largest sum."""
        return self.fixed + int(np.argmax(self.rows[self.fixed :]))

    def _changes(self, column: np.ndarray, row: int, others: np.ndarray) -> FloatArray:
        """(m,) growth of the total when a row exchanges its entry of a column with each of the others."""
        m = len(others)
        theirs, mine, yours, a, b, work = (buffer[:m] for buffer in self._buffers)
        own = (column - column[row]) ** 2
        np.subtract(column, column[others][:, None], out=theirs)
        np.square(theirs, out=theirs)
        np.add(theirs, self.square[row] - own, out=mine)
        np.add(np.take(self.square, others, axis=0, out=yours), own, out=yours)
        yours -= theirs
        places = np.arange(m)
        for squares, powers in ((mine, a), (yours, b)):
            _powers(squares, powers, work)
            powers[places, others] = 0.0
            powers[:, row] = 0.0
        after = a.sum(axis=1) + b.sum(axis=1)
        return np.asarray(after - self.rows[row] - self.rows[others] + 2.0 * self.inverse[row, others])

    def _try_exchange(self, column: FloatArray, row: int, other: int, threshold: float) -> None:
        """Exchange two entries of a column, unless the total grows by more than the threshold."""
        moved = (column - column[other]) ** 2 - (column - column[row]) ** 2
        between, rows = self.square[row, other], []
        for place, change in ((row, moved), (other, -moved)):
            squares = np.maximum(self.square[place] + change, LEAST_SQUARE)
            squares[[row, other]] = between
            squares = squares.astype(np.float32)
            powers = _powers(squares, np.empty_like(squares), np.empty_like(squares))
            powers[place] = 0.0
            rows.append((place, squares, powers, float(powers.sum(dtype=float))))
        growth = rows[0][3] + rows[1][3] - self.rows[row] - self.rows[other]
        if growth > threshold * self.total:
            return
        if growth > 0.0 and self.total < self._least:
            self._least, self._best = self.total, self.x.copy()
        column[row], column[other] = column[other], column[row]
        for place, squares, powers, total in rows:
            self.rows += powers - self.inverse[place].astype(float)
            self.rows[place] = total
            self.square[place] = self.square[:, place] = squares
            self.inverse[place] = self.inverse[:, place] = powers
        self.total += growth


def _powers(squares: np.ndarray, out: np.ndarray, work: np.ndarray) -> np.ndarray:
    """Squared distances to the power -p / 2, into `out`."""
    np.maximum(squares, LEAST_SQUARE, out=out)
    np.reciprocal(out, out=out)
    np.square(out, out=work)
    np.square(work, out=work)
    return np.asarray(np.multiply(out, work, out=out))


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
