"""Constraints as one-sided squares."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.constraint_penalty import WALL_MARGIN, WALL_STIFFNESS, ConstraintPenalty
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
