from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from doe_kc.axle_file import read_axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.least_squares import (
    WALL_MARGIN,
    WALL_STIFFNESS,
    ConstraintPenalty,
    bounded_step,
    normal_equations,
    with_prior,
)
from doe_kc.targets import build_targets
from doe_kc.targets.options import CharacteristicOptions
from tests.correlation.cases import AXLE

WALLS = ConstraintPenalty(np.array([3, 4]), np.array([-1.0, 2.0]), np.array([1.0, 6.0]), np.array([0.1, 0.5]))


def test_inside_costs_nothing_and_outside_is_counted_in_sd() -> None:
    np.testing.assert_allclose(WALLS.excess(np.array([0.99, 2.0])), [0.0, 0.0])
    np.testing.assert_allclose(WALLS.excess(np.array([1.2, 1.0])), [2.0, -2.0])
    np.testing.assert_array_equal(WALLS.sides(np.array([-3.0, 7.0])), [-1, 1])


def test_distance_is_signed_from_the_wall_that_is_named() -> None:
    found = WALLS.distance(np.array([0.8, 1.0]), np.array([1, 0]))
    np.testing.assert_allclose(found, [-2.0, 0.0])


def test_a_wall_stands_just_inside_every_constraint_of_the_targets() -> None:
    options = [
        CharacteristicOptions(match="vertical.bump_steer", target=-5.0, low=-6.0, high=-4.0),
        CharacteristicOptions(match="roll.roll_steer", target=-1.0, constraint=False),
    ]
    targets = build_targets(read_axle(AXLE), None, options, [], source="test")
    walls = ConstraintPenalty.of(targets)
    assert walls.rows.tolist() == [list(CHARACTERISTICS).index("vertical.bump_steer")]
    assert walls.sd == pytest.approx([WALL_STIFFNESS])
    assert (walls.low[0], walls.high[0]) == pytest.approx((-6.0 + WALL_MARGIN, -4.0 - WALL_MARGIN))


def test_targets_without_a_constraint_have_no_wall() -> None:
    options = [CharacteristicOptions(match="vertical.bump_steer", target=-5.0, constraint=False)]
    walls = ConstraintPenalty.of(build_targets(read_axle(AXLE), None, options, [], source="test"))
    assert walls.excess(np.zeros(0)).size == 0


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("d", [1, 5, 40])
def test_equals_an_interior_point_solution(seed: int, d: int) -> None:
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((d + 3, d)) * 10.0 ** rng.uniform(-2, 2, d)
    wish = rng.standard_normal(d + 3) * 5.0
    lower, upper = -rng.uniform(0.0, 0.3, d), rng.uniform(0.01, 0.3, d)
    found = bounded_step(root.T @ root, -root.T @ wish, lower, upper)
    known = lsq_linear(root, wish, (lower - 1e-15, upper), method="trf", tol=1e-14, max_iter=2000)
    assert np.all((found >= lower) & (found <= upper))
    assert np.sum((root @ found - wish) ** 2) <= 2.0 * known.cost * (1.0 + 1e-7) + 1e-9


def test_a_box_of_nothing_gives_no_step() -> None:
    zero = np.zeros(3)
    assert np.all(bounded_step(np.eye(3), np.ones(3), zero, zero) == 0.0)


def test_unbounded_is_newton() -> None:
    hessian = np.array([[4.0, 1.0], [1.0, 3.0]])
    gradient = np.array([1.0, -2.0])
    found = bounded_step(hessian, gradient, np.full(2, -10.0), np.full(2, 10.0))
    np.testing.assert_allclose(found, -np.linalg.solve(hessian, gradient), rtol=1e-10)


def test_normal_equations_are_the_slopes_of_the_cost() -> None:
    rng = np.random.default_rng(4)
    jacobian, residual = rng.standard_normal((9, 4)), rng.standard_normal(9)
    weight, moved = rng.uniform(0.5, 2.0, 4), rng.standard_normal(4)
    hessian, gradient = normal_equations(jacobian, residual, weight, moved)

    def cost(step: np.ndarray) -> float:
        misfit = residual + jacobian @ step
        return float(0.5 * misfit @ misfit + 0.5 * weight @ (moved + step) ** 2)

    step = rng.standard_normal(4)
    promised = gradient @ step + 0.5 * step @ hessian @ step
    assert cost(step) - cost(np.zeros(4)) == pytest.approx(promised)
    flat, _ = with_prior(np.zeros((4, 4)), gradient, np.zeros(4), moved, flat=0.1)
    assert flat == pytest.approx(0.1 * np.eye(4))
