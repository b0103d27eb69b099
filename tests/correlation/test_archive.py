"""Principal axes of the curves: the plain singular value decomposition's, and no more of them than needed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from doe_kc.correlation.modelled.archive import UNRESOLVED, principal_axes
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Blocks:
    """What the axes need of the targets: where each curve lies."""

    blocks: tuple[slice, ...]


BLOCKS = Blocks((slice(0, 30), slice(30, 31), slice(31, 90)))


def curves(designs: int, rank: int) -> FloatArray:
    rng = np.random.default_rng(designs)
    falling = 10.0 ** -np.linspace(0.0, 5.0, rank)
    return np.asarray((rng.standard_normal((designs, rank)) * falling) @ rng.standard_normal((rank, 90)))


def left_out(left: FloatArray, basis: FloatArray) -> float:
    rest = left - left @ basis.T @ basis
    return float(max(np.linalg.norm(rest[:, part], axis=1).max() for part in BLOCKS.blocks))


@pytest.mark.parametrize(("designs", "rank"), [(12, 8), (60, 20), (120, 40)], ids=["few", "some", "more"])
def test_axes_are_those_of_the_decomposition_and_as_few_as_resolve(designs: int, rank: int) -> None:
    scaled = curves(designs, rank)
    mean, basis = principal_axes(scaled, BLOCKS)  # type: ignore[arg-type]  # it reads the blocks alone
    left = scaled - scaled.mean(axis=0)
    np.testing.assert_allclose(mean, scaled.mean(axis=0))
    np.testing.assert_allclose(basis @ basis.T, np.eye(len(basis)), atol=1e-9)
    known = np.linalg.svd(left, full_matrices=False)[2][: len(basis)]
    np.testing.assert_allclose(np.abs(np.sum(known * basis, axis=1)), 1.0, atol=1e-9)
    assert 1 < len(basis) < rank
    assert left_out(left, basis) <= UNRESOLVED < left_out(left, basis[:-1])


def test_designs_that_agree_need_no_axes() -> None:
    assert principal_axes(np.ones((5, 90)), BLOCKS)[1].shape == (0, 90)  # type: ignore[arg-type]


def test_without_curves_there_are_none() -> None:
    mean, basis = principal_axes(np.zeros((5, 0)), Blocks(()))  # type: ignore[arg-type]
    assert mean.shape == (0,) and basis.shape == (0, 0)
