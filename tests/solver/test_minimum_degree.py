"""Orders of elimination from places alone: little fill, and no pivot before its place is filled."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.solver.kernel import kernel
from doe_kc.solver.minimum_degree import minimum_degree_order


def order_of(pattern: np.ndarray, tail: int = 0) -> np.ndarray:
    return minimum_degree_order(*np.nonzero(pattern), len(pattern), tail)


def fill_of(pattern: np.ndarray, order: np.ndarray) -> int:
    """Entries that an elimination without swaps adds to the pattern."""
    filled = np.array(pattern, dtype=bool)[np.ix_(order, order)]
    before = filled.sum()
    for k in range(len(filled)):
        filled[k + 1 :, k + 1 :] |= np.outer(filled[k + 1 :, k], filled[k, k + 1 :])
    return int(filled.sum() - before)


def arrow(size: int) -> np.ndarray:
    pattern = np.eye(size, dtype=bool)
    pattern[0] = pattern[:, 0] = True
    return pattern


def test_the_hub_of_a_star_comes_among_the_last_and_nothing_is_filled() -> None:
    pattern = arrow(9)
    assert fill_of(pattern, np.arange(9)) == 56
    order = order_of(pattern)
    assert sorted(order) == list(range(9)) and 0 in order[-2:]
    assert fill_of(pattern, order) == 0


def test_a_pattern_that_is_not_symmetric_has_neighbours_both_ways() -> None:
    pattern = np.eye(5, dtype=bool)
    pattern[0, 1:] = True  # the equation sees all unknowns, they do not see it
    order = order_of(pattern)
    assert 0 in order[-2:]


def test_a_joint_force_waits_for_a_body_that_it_acts_on() -> None:
    pattern = np.array([[1, 0, 1], [0, 1, 0], [1, 0, 0]], dtype=bool)
    order = list(order_of(pattern))
    assert order.index(2) > order.index(0)


def test_the_tail_stays_last() -> None:
    order = order_of(arrow(6), tail=2)
    assert list(order[-2:]) == [4, 5] and sorted(order) == list(range(6))


@pytest.mark.parametrize("axle_type", EXAMPLE_TYPES)
def test_the_order_of_an_axle_fills_less_than_its_unknowns_as_they_are(axle_type: str) -> None:
    layout = kernel(read_axle(example_folder(axle_type) / "axle.toml").topology).layout
    size = len(layout.unknowns)
    assert sorted(layout.order) == list(range(size))
    head = layout.order[: size - layout.tail]
    pattern = np.zeros((size, size), dtype=bool)
    pattern[layout.rows, layout.cols] = True
    assert fill_of(pattern, head) < 0.6 * fill_of(pattern, np.arange(size - layout.tail))
