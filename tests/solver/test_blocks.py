"""Derivative blocks: compiled as interpreted, many points as one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from doe_kc.axle.topology import Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.blocks import Block, blocks, equilibrium_change, interpreted_blocks
from doe_kc.solver.kernel import kernel
from doe_kc.solver.library import find_compiler
from doe_kc.solver.suite import solve
from tests.reference import nominal

PLAIN = nominal().topology
FRICTIONAL = replace(PLAIN, strut_friction="dahl")
Point = tuple[FloatArray, FloatArray, FloatArray, FloatArray]


@pytest.fixture(scope="module")
def points() -> list[Point]:
    axle = nominal()
    c = kernel(PLAIN).constant_values(dict(axle.values))
    branch = solve(axle, ["lateral"]).cases["lateral"].branches[0]
    return [(branch.x[i], c, branch.u[i], branch.z[i]) for i in (0, 4, 9)]


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
@pytest.mark.parametrize("topology", [PLAIN, FRICTIONAL], ids=["plain", "frictional"])
def test_compiled_blocks_are_the_interpreted_ones(
    topology: Topology, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("DOE_KC_COMPILE", raising=False)
    blocks.cache_clear()
    compiled, interpreted = blocks(topology), interpreted_blocks(topology)
    assert compiled.keys() == {n for n in interpreted if n.endswith(("_x", "_u", "_z"))}
    assert ("Z_z" in compiled) == (topology is FRICTIONAL)
    rng = np.random.default_rng(5)
    for name in compiled:
        function = interpreted[name]
        at = [rng.uniform(0.5, 1.0, function.nnz_in(i)) for i in range(function.n_in())]
        expected = Block(function)(*at)
        np.testing.assert_allclose(Block(compiled[name])(*at), expected, rtol=1e-9, atol=1e-12)


def test_without_compiling_they_are_interpreted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DOE_KC_COMPILE", "0")
    blocks.cache_clear()
    assert blocks(PLAIN) is interpreted_blocks(PLAIN)
    blocks.cache_clear()


@pytest.mark.parametrize("name", ["R_c", "R_u", "Y_x"])
def test_many_points_are_as_one_by_one(name: str, points: list[Point]) -> None:
    block = Block(interpreted_blocks(PLAIN)[name])
    single = np.array([block(*point) for point in points])
    assert np.abs(single[0] - single[2]).max() > 0.0
    np.testing.assert_array_equal(block.dense(points), single)
    rng = np.random.default_rng(6)
    each = rng.standard_normal((len(points), single.shape[2], 5))
    np.testing.assert_allclose(block.times_each(points, each), single @ each, rtol=1e-9, atol=1e-9)
    one = sparse.csr_array(each[0])
    np.testing.assert_allclose(block.times(points, one), single @ each[0], rtol=1e-9, atol=1e-9)


def test_a_singular_equilibrium_is_refused(points: list[Point]) -> None:
    k = kernel(PLAIN)
    matrix = Block(blocks(PLAIN)["R_x"]).dense(points)
    matrix[1, 3] = 0.0
    with pytest.raises(np.linalg.LinAlgError, match="no sensitivity exists"):
        equilibrium_change(k, matrix, np.ones((len(points), k.nx, 2)))
