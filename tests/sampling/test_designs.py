"""One at a time over parameters, and the slices of a Latin hypercube."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist

from doe_kc.axle import design_parameters, with_values
from doe_kc.axle.design_parameters import Parameter
from doe_kc.ground.errors import InputError
from doe_kc.sampling import sample
from doe_kc.sampling.latin_hypercube import SPREAD_UP_TO
from doe_kc.sampling.one_at_a_time import one_at_a_time
from doe_kc.variables import VariableOptions, build_space
from tests.reference import nominal


def parameters() -> list[Parameter]:
    return design_parameters(nominal())


def test_one_at_a_time_is_nominal_then_up_and_down() -> None:
    rows = parameters()
    design = one_at_a_time(rows)
    base = np.array([p.nominal for p in rows])
    assert design.method == "one_at_a_time" and design.seed is None
    assert design.paths == tuple(p.path for p in rows)
    assert design.values.shape == (1 + 2 * len(rows), len(rows)) == (len(design.labels), len(rows))
    np.testing.assert_array_equal(design.values[0], base)
    for i, parameter in enumerate(rows):
        up, down = design.values[1 + 2 * i] - base, design.values[2 + 2 * i] - base
        assert np.flatnonzero(up).tolist() == [i] and up[i] == pytest.approx(parameter.step)
        if parameter.path == "strut.flexibility":
            assert not down.any()
        else:
            assert np.flatnonzero(down).tolist() == [i] and down[i] == pytest.approx(-parameter.step)


def test_steps_are_a_millimetre_or_ten_percent() -> None:
    steps = {p.path: p.step for p in parameters()}
    assert {s for p, s in steps.items() if p[0].isupper()} == {1.0}
    assert {s for p, s in steps.items() if p.startswith(("ll", "sf", "upb"))} == {0.1}
    rate = next(p for p in parameters() if p.path == "spring.rate")
    assert rate.step == pytest.approx(0.1 * rate.nominal)


def test_labels_say_what_a_row_is() -> None:
    few = [p for p in parameters() if p.path in {"LLF.x", "llr.Fx"}]
    assert one_at_a_time(few).labels == (
        "nominal",
        "LLF.x +1 mm",
        "LLF.x -1 mm",
        "llr.Fx +0.1",
        "llr.Fx -0.1",
    )


def test_only_a_parameter_at_zero_is_one_sided() -> None:
    assert [p.path for p in parameters() if p.one_sided] == ["strut.flexibility"]
    flexible = with_values(nominal(), {"strut.flexibility": 0.5})
    assert not any(p.one_sided for p in design_parameters(flexible))


def test_rows_are_axles() -> None:
    for row in one_at_a_time(parameters()).rows():
        with_values(nominal(), row)


SPACE = build_space(nominal(), VariableOptions(levels="continuous"), "test")
SMALL = build_space(nominal(), VariableOptions(use=["LLF.*", "llr.Fx"], levels="continuous"), "test")


@settings(max_examples=15, deadline=None)
@given(st.sampled_from([1, 2, 5, 12, SPREAD_UP_TO + 1]), st.integers(0, 2**32 - 1))
def test_every_slice_is_hit_once(n: int, seed: int) -> None:
    space = SPACE if n > SPREAD_UP_TO else SMALL
    design = sample(space, n, seed=seed)
    shares = np.array([space.unit(row) for row in design.rows()])
    for i, path in enumerate(space.paths):
        slices = np.clip(np.floor(shares[:, i] * n + 1e-9), 0, n - 1).astype(int)
        assert sorted(slices) == list(range(n)), path


def test_a_small_hypercube_is_more_even_than_chance() -> None:
    from scipy.stats import qmc

    design = sample(SMALL, 40, seed=1)
    ours = qmc.discrepancy(np.array([SMALL.unit(row) for row in design.rows()]))
    plain = [qmc.discrepancy(qmc.LatinHypercube(4, rng=s).random(40)) for s in range(10)]
    assert ours < 0.8 * np.mean(plain)


def test_more_sobol_points_keep_the_first_ones() -> None:
    few, many = (sample(SMALL, n, seed=1, method="sobol").values for n in (100, 200))
    np.testing.assert_array_equal(few, many[:100])


def test_designs_are_as_far_apart_as_those_of_smt() -> None:
    """SMT's ESE reaches 3.38 with 50 designs of 72 variables, a plain hypercube 2.9."""
    design = sample(SPACE, 50, seed=1)
    points = np.array([SPACE.unit(row) for row in design.rows()])
    assert pdist(points).min() > 3.3 * np.sqrt(SPACE.dimension / 72)


def test_a_grown_hypercube_keeps_its_designs_and_fills_empty_slices() -> None:
    first = sample(SMALL, 20, seed=1)
    known = np.array([SMALL.unit(row) for row in first.rows()])
    new = sample(SMALL, 10, seed=2, existing=known)
    places = np.array([SMALL.unit(row) for row in new.rows()])
    assert new.labels[0] == "sample 21"
    for column, before in zip(places.T, known.T, strict=True):
        slices = (30 * column).astype(int)
        assert len(set(slices)) == 10
        assert not set(slices) & set((30 * before).astype(int))
    assert pdist(np.vstack([known, places])).min() > 0.5 * pdist(known).min()


def test_a_method_that_cannot_complete_designs_says_which_can() -> None:
    with pytest.raises(InputError, match="sobol cannot complete existing designs; use lhs"):
        sample(SMALL, 5, seed=1, method="sobol", existing=np.full((1, SMALL.dimension), 0.5))
