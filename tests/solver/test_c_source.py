"""Generated C: what CasADi evaluates itself, for every operation."""

from __future__ import annotations

from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver import c_source as module
from doe_kc.solver.c_source import c_sources
from doe_kc.solver.dialect import EXPRESSIONS
from doe_kc.solver.library import CACHE_VARIABLE, CompileError, build, find_compiler

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")


@pytest.fixture(autouse=True)
def cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))


def square(a: ca.SX) -> ca.SX:
    return a * a


def every_operation() -> ca.Function:
    """Of two arguments in (0, 1): each operation on values that are defined and not equal."""
    x, y = ca.SX.sym("x", 3), ca.SX.sym("y", ca.Sparsity.lower(2))
    a, b, c, (d, e, _) = x[0], x[1], x[2], ca.vertsplit(ca.vertcat(*y.nonzeros()))
    truth = [a < b, a <= b, ca.eq(a, b), ca.ne(a, b), ca.logic_and(a < b, c > d), ca.logic_or(a < b, c > d)]
    truth += [ca.logic_not(a < b), ca.if_else(a < b, c, d), ca.if_else(a - 0.5, e, 2.0)]
    one = [f(a * 0.9) for f in (ca.sqrt, ca.exp, ca.log, ca.sin, ca.cos, ca.tan, ca.asin, ca.acos, ca.atan)]
    one += [f(b - 0.5) for f in (ca.sinh, ca.cosh, ca.tanh, ca.fabs, ca.sign, ca.erf, square)]
    one += [f(b - 0.5) for f in (ca.asinh, ca.atanh, ca.log1p, ca.expm1)] + [ca.acosh(1.0 + a)]
    one += [ca.floor(5.0 * a), ca.ceil(5.0 * b), -a, 1.0 / b, a + a]
    two = [a + b, a - b, a * b, a / b, a**b, b**3.5, ca.atan2(a, b), ca.fmin(a, b), ca.fmax(a, b)]
    two += [ca.hypot(a, b), ca.remainder(3.0 * a, b)]
    two += [ca.copysign(a, b - 0.5), ca.fmod(3.0 * a, b), a * 1e-300, b - float("inf")]
    return ca.Function("every", [x, y], [ca.vertcat(*truth, *one, *two), y * a])


def arguments(function: ca.Function, count: int) -> list[np.ndarray]:
    rng = np.random.default_rng(4)
    return [rng.uniform(0.05, 0.95, (function.nnz_in(i), count)) for i in range(function.n_in())]


def expected(function: ca.Function, at: list[np.ndarray], lane: int) -> list[np.ndarray]:
    inputs = [ca.DM(function.sparsity_in(i), a[:, lane]) for i, a in enumerate(at)]
    return [np.array(result.nonzeros()) for result in function.call(inputs)]


def test_the_function_of_the_tests_has_every_operation() -> None:
    function = every_operation()
    codes = {function.instruction_id(k) for k in range(function.n_instructions())}
    assert not set(EXPRESSIONS) - codes - {ca.OP_ASSIGN, ca.OP_CONSTPOW, ca.OP_TWICE, ca.OP_INV}


@pytest.mark.parametrize("piece", [5, 300])
def test_it_is_what_casadi_evaluates(piece: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PIECE", piece)
    monkeypatch.setattr(module, "PIECES_A_FILE", 3)
    function = every_operation()
    loaded = ca.external("every", str(build(c_sources(function))))
    for i in range(function.n_out()):
        assert loaded.sparsity_out(i) == function.sparsity_out(i)
    at = arguments(function, 5)
    for lane in range(5):
        own = loaded.call([ca.DM(function.sparsity_in(i), a[:, lane]) for i, a in enumerate(at)])
        for mine, other in zip(own, expected(function, at, lane), strict=True):
            np.testing.assert_allclose(np.array(mine.nonzeros()), other, rtol=1e-14)


def test_an_operation_without_c_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(EXPRESSIONS, ca.OP_SIN)
    with pytest.raises(CompileError, match="every has no C expression"):
        c_sources(every_operation())
