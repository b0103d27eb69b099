"""One at a time and Latin hypercube."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from doe_kc.axle import design_parameters, with_values
from doe_kc.axle.parameters import Parameter
from doe_kc.sampling.latin_hypercube import latin_hypercube
from doe_kc.sampling.one_at_a_time import is_one_sided, one_at_a_time
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
    assert [p.path for p in parameters() if is_one_sided(p)] == ["strut.flexibility"]
    flexible = with_values(nominal(), {"strut.flexibility": 0.5})
    assert not any(is_one_sided(p) for p in design_parameters(flexible))


def test_rows_are_axles() -> None:
    for row in one_at_a_time(parameters()).rows():
        with_values(nominal(), row)


def position(parameter: Parameter, values: np.ndarray) -> np.ndarray:
    """Between 0 and 1 within the bounds; of factors, in the logarithm."""
    low, high = parameter.lower, parameter.upper
    if parameter.unit == "-" and low > 0:
        low, high, values = np.log(low), np.log(high), np.log(values)
    return np.asarray((values - low) / (high - low))


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 60), st.integers(0, 2**32 - 1))
def test_every_slice_is_hit_once(n: int, seed: int) -> None:
    rows = parameters()
    design = latin_hypercube(rows, n, seed=seed)
    assert design.values.shape == (n, len(rows)) and design.seed == seed and len(design.labels) == n
    for i, parameter in enumerate(rows):
        share = position(parameter, design.values[:, i])
        assert (share > -1e-12).all() and (share < 1 + 1e-12).all(), parameter.path
        slices = np.clip(np.floor(share * n + 1e-9 * (share < 1)).astype(int), 0, n - 1)
        assert sorted(slices) == list(range(n)), parameter.path


def test_factors_are_even_in_their_logarithm() -> None:
    rows = parameters()
    design = latin_hypercube(rows, 1000, seed=1)
    column = design.values[:, design.paths.index("llr.Fx")]
    assert (column < 1.0).mean() == pytest.approx(0.5, abs=0.002)
    assert column.min() >= 0.5 and column.max() <= 2.0


def test_the_seed_decides() -> None:
    rows = parameters()
    first, again, other = (latin_hypercube(rows, 20, seed=s) for s in (7, 7, 8))
    np.testing.assert_array_equal(first.values, again.values)
    assert np.abs(first.values - other.values).max() > 0


def test_optimized_is_a_hypercube_still() -> None:
    rows = parameters()[:4]
    design = latin_hypercube(rows, 12, seed=3, optimize=True)
    for i, parameter in enumerate(rows):
        share = position(parameter, design.values[:, i])
        assert sorted(np.floor(share * 12).astype(int)) == list(range(12))
    again = latin_hypercube(rows, 12, seed=3, optimize=True)
    np.testing.assert_array_equal(design.values, again.values)


def test_a_flexibility_from_zero_is_even_as_it_is() -> None:
    flexibility = next(p for p in parameters() if p.path == "strut.flexibility")
    design = latin_hypercube([replace(flexibility, lower=0.0, upper=2.0)], 100, seed=1)
    assert design.values.mean() == pytest.approx(1.0, abs=0.02) and design.values.min() >= 0.0
