"""Orders of elimination: they solve what they are made for, and other numbers in the same places."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from doe_kc.effects import apply_effect
from doe_kc.ground.typing import FloatArray
from doe_kc.solver import elimination
from doe_kc.solver.elimination import EliminationOrder, elimination_order, paired_order
from doe_kc.solver.kernel import Kernel, interpreted_functions, kernel
from doe_kc.solver.suite import solve
from tests.reference import nominal

SIZE, EXTRA = 14, 2


def sparse_matrix(rng: np.random.Generator) -> tuple[SimpleNamespace, np.ndarray]:
    """Places and numbers of a matrix with zeros on its diagonal, which needs pivots."""
    n = SIZE + EXTRA
    pattern = rng.random((n, n)) < 0.2
    pattern[np.arange(n), (np.arange(n) + 3) % SIZE] = True
    np.fill_diagonal(pattern, False)
    pattern[SIZE:, SIZE:] = np.eye(EXTRA, dtype=bool)
    rows, cols = np.nonzero(pattern)
    scale = np.where(np.arange(n) % 3, 1.0, 100.0)
    numbers = rng.normal(size=len(rows))
    numbers[(np.arange(len(rows)) % 5) == 0] *= 3.0
    return SimpleNamespace(rows=rows, cols=cols, scale=scale), numbers


def solution(
    kernel: SimpleNamespace, order: EliminationOrder, numbers: np.ndarray, right: np.ndarray
) -> np.ndarray:
    """As batch.c does it, in one lane."""
    m, lower = len(order.row_of), len(order.l_row)
    upper = lower + len(order.u_column)
    f, target = np.zeros(upper + m), iter(order.target)
    there = order.place >= 0
    f[order.place[there]] = (numbers / kernel.scale[kernel.rows])[there]
    for k in range(m):
        f[upper + k] = 1.0 / f[upper + k]
        row = f[lower + order.u_start[k] : lower + order.u_start[k + 1]]
        for i in range(order.l_start[k], order.l_start[k + 1]):
            f[i] *= f[upper + k]
            for v in row:
                f[next(target)] -= f[i] * v
    y = (right / kernel.scale)[order.row_of]
    for k in range(m):
        for i in range(order.l_start[k], order.l_start[k + 1]):
            y[order.l_row[i]] -= f[i] * y[k]
    for k in reversed(range(m)):
        for j in range(order.u_start[k], order.u_start[k + 1]):
            y[k] -= f[lower + j] * y[order.u_column[j]]
        y[k] *= f[upper + k]
    out = np.zeros(m)
    out[order.column_of] = y
    return out


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("active", [SIZE, SIZE + EXTRA])
def test_an_order_solves_its_matrix_and_those_like_it(seed: int, active: int) -> None:
    rng = np.random.default_rng(seed)
    kernel, numbers = sparse_matrix(rng)
    order = elimination_order(kernel, numbers, active)  # type: ignore[arg-type]  # what it asks of a kernel
    for _ in range(3):
        matrix = np.zeros((SIZE + EXTRA, SIZE + EXTRA))
        matrix[kernel.rows, kernel.cols] = numbers
        right = rng.normal(size=SIZE + EXTRA)
        expected = np.linalg.solve(matrix[:active, :active], right[:active])
        np.testing.assert_allclose(solution(kernel, order, numbers, right), expected, rtol=1e-8, atol=1e-10)
        numbers = numbers * rng.uniform(0.9, 1.1, len(numbers))


def test_a_singular_matrix_has_no_order() -> None:
    kernel, numbers = sparse_matrix(np.random.default_rng(0))
    numbers[kernel.cols == 2] = 0.0
    with pytest.raises(np.linalg.LinAlgError, match="no order of elimination"):
        elimination_order(kernel, numbers, SIZE)  # type: ignore[arg-type]


def at_rest(effect: str) -> tuple[Kernel, FloatArray]:
    """An axle's kernel, and the numbers of its Jacobian at rest."""
    axle = apply_effect(nominal(), effect, {}, source="test")
    k, static = kernel(axle.topology), solve(axle, []).static
    assert static is not None
    c = k.constant_values(dict(axle.values))
    jacobian = interpreted_functions(axle.topology)["jacobian"](static.x, c, static.u, static.z)
    return k, np.array(jacobian.nonzeros())


@pytest.mark.parametrize("effect", ["hub_compliance", "strut_bending", "rubber_hysteresis"])
@pytest.mark.parametrize("full", [False, True])
def test_pairs_solve_an_axle(effect: str, full: bool) -> None:
    k, numbers = at_rest(effect)
    active = k.nx if full else k.nx - k.layout.tail
    order = paired_order(k, numbers, active)
    matrix = np.zeros((k.nx, k.nx))
    matrix[k.rows, k.cols] = numbers
    right = np.random.default_rng(1).normal(size=k.nx)
    expected = np.linalg.solve(matrix[:active, :active], right[:active])
    np.testing.assert_allclose(
        solution(k, order, numbers, right),  # type: ignore[arg-type]  # what it asks of a kernel
        expected,
        rtol=1e-7,
        atol=1e-9 * np.abs(expected).max(),
    )


def test_a_pair_whose_pivot_is_small_is_put_off() -> None:
    k, numbers = at_rest("strut_bending")
    active = k.nx - k.layout.tail
    order = paired_order(k, numbers, active)
    np.testing.assert_array_equal(order.row_of, order.column_of)
    assert sorted(order.row_of) == list(range(active))
    assert not np.array_equal(order.row_of, k.layout.order[:active])


def test_where_pairs_lead_to_no_end_rows_are_exchanged(monkeypatch: pytest.MonkeyPatch) -> None:
    k, numbers = at_rest("hub_compliance")
    active = k.nx - k.layout.tail
    expected = elimination_order(k, numbers, active)
    asked: list[int] = []

    def counted(*arguments: object) -> EliminationOrder:
        asked.append(1)
        return expected

    monkeypatch.setattr(elimination, "PIVOT_THRESHOLD", 2.0)
    monkeypatch.setattr(elimination, "elimination_order", counted)
    assert paired_order(k, numbers, active) is expected and asked
