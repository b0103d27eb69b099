"""Many minimisations at once: SciPy's minima, each as if it were alone."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize, rosen, rosen_der

from doe_kc.surrogate_models.batch_descent import minimise

START = np.random.default_rng(0).uniform(-1.0, 2.0, (6, 4))
WIDE = np.full_like(START, 10.0)


def valleys(points: np.ndarray, problems: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rosenbrock's function, of another minimum in each problem."""
    shifted = points - 0.1 * problems[:, None]
    return np.array([rosen(p) for p in shifted]), np.array([rosen_der(p) for p in shifted])


def test_each_problem_comes_to_its_minimum() -> None:
    found = minimise(valleys, START, evaluations=200, low=-WIDE, high=WIDE)
    assert found == pytest.approx(1.0 + 0.1 * np.arange(6)[:, None] + np.zeros(4), abs=1e-3)


def test_one_problem_does_not_depend_on_the_others() -> None:
    together = minimise(valleys, START, evaluations=15, low=-WIDE, high=WIDE)
    alone = minimise(lambda x, k: valleys(x, k + 2), START[2:3], evaluations=15, low=-WIDE[:1], high=WIDE[:1])
    np.testing.assert_allclose(alone[0], together[2], rtol=1e-12)


def test_it_needs_about_as_many_evaluations_as_scipy() -> None:
    for row in START:
        theirs = minimize(rosen, row, jac=rosen_der, method="L-BFGS-B", options={"maxfun": 25})
        ours = minimise(lambda x, _: valleys(x, np.zeros(1)), row[None], evaluations=35,
                        low=-WIDE[:1], high=WIDE[:1])  # fmt: skip
        assert rosen(ours[0]) <= max(theirs.fun, 1e-3)


def test_bounds_hold() -> None:
    found = minimise(valleys, np.zeros_like(START), evaluations=60, low=-WIDE, high=np.full_like(START, 0.5))
    assert found.max() == 0.5
    assert found.min() >= -10.0


def test_a_problem_at_rest_is_evaluated_no_more() -> None:
    seen: list[int] = []

    def bowl(points: np.ndarray, problems: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        seen.extend(problems)
        return 0.5 * (points**2).sum(axis=1), points

    minimise(bowl, np.array([[0.0, 0.0], [0.5, 0.5]]), evaluations=30, low=-WIDE[:2, :2], high=WIDE[:2, :2])
    assert seen.count(0) == 1
    assert seen.count(1) == 2
