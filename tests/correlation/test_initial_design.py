"""The opening sample: where it lies, how many designs it has, which method opens how."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.correlation.methods._sampled import BROAD
from doe_kc.correlation.methods.ego.method import OPENING, WITH_SLOPES
from doe_kc.correlation.modelled.initial_design import InitialDesign
from doe_kc.ground.typing import FloatArray
from doe_kc.variables import Change, Space, VariableOptions, build_space
from tests.correlation.cases import AXLE, problem

EVERY = pytest.mark.parametrize("opening", [OPENING, WITH_SLOPES, BROAD], ids=["values", "slopes", "broad"])


def points(opening: InitialDesign, space: Space, n: int, seed: int = 1) -> FloatArray:
    return np.array([c.point for c in opening.sample(space, n, seed)])


@EVERY
def test_lies_near_the_start_on_the_levels(opening: InitialDesign) -> None:
    space = problem("car_b").space
    found = points(opening, space, 24)
    np.testing.assert_array_equal(found, space.snapped(found))
    assert np.abs(found - space.start).max() <= opening.half_width + 0.005
    np.testing.assert_array_equal(found, points(opening, space, 24))
    assert not np.array_equal(found, points(opening, space, 24, seed=2))


@EVERY
@pytest.mark.parametrize("distribution", ["uniform", "gaussian"])
@pytest.mark.parametrize("start", [210.0, 214.0])
def test_a_start_beside_its_bound_is_no_design_twice(
    opening: InitialDesign, distribution: str, start: float
) -> None:
    changes = [Change(match="LLF.z", range=[210.0, 214.0], start=start)]
    options = VariableOptions(use=["LLF.z"], levels="continuous", distribution=distribution, change=changes)  # type: ignore[arg-type]
    found = points(opening, build_space(read_axle(AXLE), options, "test"), 12)[:, 0]
    assert len(np.unique(found)) == 12
    assert 0.0 < np.abs(found - (start - 210.0) / 4.0).max() <= 2.0 * opening.half_width


@EVERY
@pytest.mark.parametrize("levels", [2, 3, 5, 8])
def test_coarse_levels_are_left_too(opening: InitialDesign, levels: int) -> None:
    space = problem("car_b", VariableOptions(levels=levels)).space
    found = points(opening, space, 8)
    np.testing.assert_array_equal(found, space.snapped(found))
    assert found.min() >= 0.0 and found.max() <= 1.0
    assert len(np.unique(np.vstack([found, space.snapped(space.start)]), axis=0)) == 9


def test_an_evened_sample_is_a_latin_hypercube_too() -> None:
    space = problem("car_b", VariableOptions(levels="continuous")).space
    for opening in (OPENING, BROAD):
        place = (points(opening, space, 10) - space.start) / (2.0 * opening.half_width) + 0.5
        strata = np.sort(np.floor(10.0 * place), axis=0)
        assert (strata == np.arange(10)[:, None]).all()


def test_size() -> None:
    space = problem("car_b").space
    assert space.dimension == 72
    assert [o.size(space) for o in (OPENING, WITH_SLOPES, BROAD)] == [8, 2, 24]
    few = problem("car_b", VariableOptions(use=["LLF.?"])).space
    assert [o.size(few) for o in (OPENING, WITH_SLOPES, BROAD)] == [8, 2, 20]
    assert [o.size(space, 7) for o in (OPENING, WITH_SLOPES, BROAD)] == [7, 7, 7]
