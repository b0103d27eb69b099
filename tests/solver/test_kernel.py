"""Kernels from the cache: the same names, sizes and constants, without assembling equations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.solver import kernel as kernels
from doe_kc.solver.assembly import assemble
from doe_kc.solver.differentiation import derivatives
from doe_kc.solver.kernel import interpreted_functions, kernel, kernel_operations
from doe_kc.solver.layout import layout_text, read_layout
from doe_kc.solver.library import CACHE_VARIABLE, find_compiler
from doe_kc.solver.operations import Operations, operations_of
from doe_kc.solver.suite import library_for
from tests.reference import nominal

TOPOLOGY = nominal().topology


@pytest.fixture
def cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    kernel.cache_clear()
    yield tmp_path
    kernel.cache_clear()


def test_a_layout_is_read_as_it_was_written() -> None:
    frictional = replace(TOPOLOGY, steering_friction="dahl", strut_friction="iwan", strut_bending=True)
    own, eq = kernel(frictional).layout, assemble(frictional)
    again = read_layout(layout_text(own))
    assert (again.unknowns, again.tail, again.slips) == (eq.unknowns, eq.tail, eq.slips)
    assert again.parameter_names == eq.parameter_names
    assert again.control_names == eq.control_names
    assert again.output_names == eq.output_names
    assert again.states == eq.z.numel() > 0
    pattern = interpreted_functions(frictional)["jacobian"].sparsity_out(0)
    np.testing.assert_array_equal(np.array(pattern.get_triplet()), [again.rows, again.cols])


def test_a_second_kernel_assembles_nothing(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = kernel(TOPOLOGY).layout
    kernel.cache_clear()
    monkeypatch.setattr(kernels, "interpreted_functions", lambda _: pytest.fail("was assembled"))
    assert kernel(TOPOLOGY).layout.unknowns == first.unknowns


@pytest.mark.parametrize("damage", ["", "{}", '{"unknowns": 3}'])
def test_a_damaged_layout_is_made_anew(cache: Path, damage: str) -> None:
    first = kernel(TOPOLOGY).layout
    (stored,) = cache.glob("*.json")
    stored.write_text(damage)
    kernel.cache_clear()
    assert kernel(TOPOLOGY).layout.output_names == first.output_names
    assert stored.read_text() == layout_text(first)


def test_a_cache_that_cannot_be_written_is_passed_over(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "file" / "cache"))
    kernel.cache_clear()
    assert kernel(TOPOLOGY).nx == len(assemble(TOPOLOGY).unknowns)
    kernel.cache_clear()


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
def test_compiled_constants_are_the_interpreted_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DOE_KC_COMPILE", raising=False)
    kernel.cache_clear()
    assert library_for(TOPOLOGY, True) is not None
    own, values = kernel(TOPOLOGY), dict(nominal().values)
    p = np.array([values[name] for name in own.layout.parameter_names])
    interpreted = np.asarray(interpreted_functions(TOPOLOGY)["constants"](p)).ravel()
    assert own.constants.class_name() == "External"
    np.testing.assert_allclose(own.constant_values(values), interpreted, rtol=1e-14)


@pytest.mark.parametrize("name", EXAMPLE_TYPES)
def test_the_jacobian_has_the_places_of_the_layout_on_every_type(name: str) -> None:
    topology = read_axle(example_folder(name) / "axle.toml").topology
    own, layout = kernel_operations(topology), kernel(topology).layout
    (pattern,) = own["jacobian"].patterns
    np.testing.assert_array_equal(np.array(pattern.get_triplet()), [layout.rows, layout.cols])
    casadis = operations_of(interpreted_functions(topology)["jacobian"])
    assert len(own["jacobian"].rows) < len(casadis.rows)


def test_a_jacobian_of_other_places_is_casadis(monkeypatch: pytest.MonkeyPatch) -> None:
    """A derivative that is nought everywhere may be known as such in one way only."""
    expected = operations_of(interpreted_functions(TOPOLOGY)["jacobian"])

    def fewer(operations: Operations, blocks: Sequence[tuple[int, int]]) -> Operations:
        whole = derivatives(operations, blocks)
        return replace(whole, patterns=(ca.Sparsity(*whole.patterns[0].shape),))

    monkeypatch.setattr(kernels, "derivatives", fewer)
    own = kernel_operations(TOPOLOGY)["jacobian"]
    np.testing.assert_array_equal(own.rows, expected.rows)
    assert own.patterns == expected.patterns
