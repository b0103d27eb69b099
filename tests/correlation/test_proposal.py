"""Moves on the levels: never worse than rounding, mostly far better."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from doe_kc.correlation.modelled.proposal import descend


@pytest.mark.parametrize("seed", range(5))
def test_descends_to_where_no_move_of_one_or_two_helps(seed: int) -> None:
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((4, 8))
    hessian, gradient = root.T @ root + 1e-6 * np.eye(8), 3.0 * rng.standard_normal(8)
    moves = descend(hessian, gradient, np.full(8, -3.0), np.full(8, 3.0))

    def value(s: np.ndarray) -> float:
        return float(0.5 * s @ hessian @ s + gradient @ s)

    values = [0.0] + [value(m) for m in moves]
    assert all(b < a for a, b in pairwise(values))
    last = moves[-1]
    assert np.abs(last).max() <= 3.0
    for i in range(8):
        for j in range(8):
            for a in (-1.0, 0.0, 1.0):
                for b in (-1.0, 1.0):
                    other = last.copy()
                    other[i] += a
                    other[j] += b
                    if np.abs(other).max() <= 3.0 and np.abs(other - last).max() <= 1.0:
                        assert value(other) >= values[-1] - 1e-9


def test_no_move_at_a_minimum() -> None:
    assert descend(np.eye(3), np.zeros(3), -np.ones(3), np.ones(3)) == []
