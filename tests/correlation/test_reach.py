"""What the bounds allow, on linear problems whose answer is known."""

from __future__ import annotations

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.reach import conflict, reaches, unreachable
from doe_kc.targets import Constraint, Objective, Target

ENTRIES = list(CHARACTERISTICS.values())


def target(i: int, value: float, half: float = 0.1) -> Target:
    return Target(
        entry=ENTRIES[i], value=value, sd=0.0, objective=Objective(),
        constraint=Constraint(low=value - half, high=value + half),
    )  # fmt: skip


SLOPES = np.array([[2.0, -1.0], [0.0, 4.0]])
POINT = np.array([0.5, 0.25])


def test_span_over_the_bounds() -> None:
    np.testing.assert_allclose(reaches(np.array([1.0, 0.0]), SLOPES, POINT), [[-0.75, 2.25], [-1.0, 3.0]])


def test_targets_outside_the_span_are_named() -> None:
    span = reaches(np.array([1.0, 0.0]), SLOPES, POINT)
    found = unreachable([target(0, 5.0), target(1, 2.0)], span)
    assert [t.entry.id for t in found] == [ENTRIES[0].id]


def test_constraints_that_one_variable_cannot_serve_both() -> None:
    slopes = np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    targets = [target(0, 0.4), target(1, -0.4), target(2, 0.1)]
    found = conflict(targets, np.zeros(3), slopes, np.array([0.5, 0.5]))
    assert found is not None
    named = {t.entry.id for t in (*found.violated, *found.against)}
    assert named == {ENTRIES[0].id, ENTRIES[1].id}


def test_constraints_that_can_be_met_are_no_conflict() -> None:
    targets = [target(0, 0.2), target(1, 0.5)]
    assert conflict(targets, np.zeros(2), SLOPES, POINT) is None
