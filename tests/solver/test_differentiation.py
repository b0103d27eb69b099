"""Derivatives of lists of operations: CasADi's, of every operation and of whole axles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from doe_kc.axle.topology import Topology
from doe_kc.axle_file import read_axle
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.solver.assembly import assemble
from doe_kc.solver.dialect import EXPRESSIONS
from doe_kc.solver.differentiation import derivatives
from doe_kc.solver.kernel import kernel
from doe_kc.solver.operations import Operations, operations_of
from doe_kc.solver.suite import solve
from tests.reference import nominal

POINTS = 5
UNARY: tuple[Callable[[ca.SX], ca.SX], ...] = (
    *(ca.sqrt, ca.exp, ca.log, ca.sin, ca.cos, ca.tan, ca.asin, ca.acos, ca.atan, ca.sinh, ca.cosh),
    *(ca.tanh, ca.asinh, ca.atanh, ca.log1p, ca.expm1, ca.fabs, ca.erf),
)
BINARY: tuple[Callable[[ca.SX, ca.SX], ca.SX], ...] = (
    *(ca.fmin, ca.fmax, ca.atan2, ca.hypot, ca.copysign, ca.power),
)
PLAIN = nominal().topology
FRICTIONAL = replace(PLAIN, strut_friction="dahl", steering_friction="iwan", strut_bending=True)
RUBBER = replace(FRICTIONAL, rubber=("LLR", "UPB"))


def values(whole: Operations, arguments: list[np.ndarray]) -> list[np.ndarray]:
    """Dense results, by CasADi's own operations one after the other."""
    known = [*np.concatenate(arguments).tolist(), *whole.constants.tolist()]
    done: list[float] = []
    for code, a, b in whole.rows.tolist():
        x, y = (done[i] if i >= 0 else known[-1 - i] for i in (a, b))
        one = "{1}" not in EXPRESSIONS[code]
        if code == ca.OP_ASSIGN:
            done.append(x)
            continue
        value = ca.DM.unary(code, x) if one else ca.DM.binary(code, x, y)
        done.append(float(value))
    out = [np.zeros(pattern.nnz()) for pattern in whole.patterns]
    for result, place, operand in whole.results.tolist():
        out[result][place] = done[operand] if operand >= 0 else known[-1 - operand]
    return [np.array(ca.DM(p, numbers)) for p, numbers in zip(whole.patterns, out, strict=True)]


def assert_casadis(function: ca.Function, blocks: list[tuple[int, int]], low: float, high: float) -> None:
    """Derivatives of a function are those that CasADi makes, at random points."""
    own = derivatives(operations_of(function), blocks)
    symbols = function.sx_in()
    outputs = function.call(symbols)
    expected = ca.Function("e", symbols, [ca.jacobian(outputs[r], symbols[a]) for r, a in blocks])
    rng = np.random.default_rng(3)
    for _ in range(POINTS):
        at = [rng.uniform(low, high, function.nnz_in(i)) for i in range(function.n_in())]
        for found, there in zip(values(own, at), expected.call([ca.DM(a) for a in at]), strict=True):
            np.testing.assert_allclose(found, np.array(there), rtol=1e-9, atol=1e-10)


EXACTLY: dict[int, Callable[[np.longdouble, np.longdouble], np.longdouble | bool]] = {
    ca.OP_ADD: lambda a, b: a + b,
    ca.OP_SUB: lambda a, b: a - b,
    ca.OP_MUL: lambda a, b: a * b,
    ca.OP_DIV: lambda a, b: a / b,
    ca.OP_NEG: lambda a, _: -a,
    ca.OP_SQ: lambda a, _: a * a,
    ca.OP_TWICE: lambda a, _: a + a,
    ca.OP_INV: lambda a, _: 1 / a,
    ca.OP_SQRT: lambda a, _: np.sqrt(a),
    ca.OP_SIN: lambda a, _: np.sin(a),
    ca.OP_COS: lambda a, _: np.cos(a),
    ca.OP_ASIN: lambda a, _: np.arcsin(a),
    ca.OP_ATAN: lambda a, _: np.arctan(a),
    ca.OP_ATAN2: np.arctan2,
    ca.OP_HYPOT: np.hypot,
    ca.OP_EXP: lambda a, _: np.exp(a),
    ca.OP_FABS: lambda a, _: abs(a),
    ca.OP_SIGN: lambda a, _: np.sign(a),
    ca.OP_FMIN: min,
    ca.OP_FMAX: max,
    ca.OP_LT: lambda a, b: a < b,
    ca.OP_LE: lambda a, b: a <= b,
    ca.OP_NOT: lambda a, _: not a,
    ca.OP_IF_ELSE_ZERO: lambda a, b: b if a else np.longdouble(0),
}
"""Operations in numbers of any kind."""


def nonzeros(whole: Operations, arguments: list[np.ndarray], kind: type[np.floating]) -> list[np.ndarray]:
    """Of each result, computed in numbers of one kind."""
    known = [kind(v) for v in (*np.concatenate(arguments), *whole.constants)]
    done: list[np.floating] = []
    for code, a, b in whole.rows.tolist():
        x, y = (done[i] if i >= 0 else known[-1 - i] for i in (a, b))
        done.append(kind(EXACTLY[code](x, y)))
    out = [np.zeros(pattern.nnz(), dtype=kind) for pattern in whole.patterns]
    for result, place, operand in whole.results.tolist():
        out[result][place] = done[operand] if operand >= 0 else known[-1 - operand]
    return out


@pytest.mark.parametrize("name", EXAMPLE_TYPES)
def test_rounding_is_no_larger_than_casadis(name: str) -> None:
    """What CasADi's would be without, numbers of 80 bits tell, at an equilibrium."""
    axle = read_axle(example_folder(name) / "axle.toml")
    eq, c = assemble(axle.topology), kernel(axle.topology).constant_values(dict(axle.values))
    branch = solve(axle, ["vertical"]).cases["vertical"].branches[0]
    at = [branch.x[-1], c, branch.u[-1], branch.z[-1]]
    symbols = [eq.x, eq.c, eq.u, eq.z]
    whole = operations_of(ca.Function("whole", symbols, [ca.densify(eq.residual)]))
    own = derivatives(whole, [(0, 0), (0, 1)])
    casadis = [ca.jacobian(eq.residual, eq.x), ca.jacobian(eq.residual, eq.c)]
    other = operations_of(ca.Function("casadis", symbols, casadis))
    rounded = [nonzeros(one, at, np.float64) for one in (own, other)]
    for k, truth in enumerate(nonzeros(other, at, np.longdouble)):
        assert own.patterns[k] == other.patterns[k]
        row = np.array(own.patterns[k].row())
        largest = np.zeros(eq.residual.numel(), dtype=np.longdouble)
        np.maximum.at(largest, row, np.abs(truth))
        there = largest[row] > 0.0
        found, casadi = (
            float((np.abs(one[k] - truth)[there] / largest[row][there]).max()) for one in rounded
        )
        assert found <= 2.0 * casadi + 1e-15


def test_of_every_operation() -> None:
    a, b = ca.SX.sym("a"), ca.SX.sym("b")
    terms = [f(a) for f in UNARY] + [f(a, b) for f in BINARY]
    terms += [a + b, a - b, a * b, a / b, -a, a * a, 1 / a, 2 * a, ca.acosh(1 + a), a**3.5]
    terms += [ca.if_else(a > 0.3, b * a, a), (a < b) * a, ca.sign(a - b) * b, ca.floor(3 * a) * b]
    terms += [a * ca.logic_and(a > 0.3, b > 0.3), ca.fmod(3 * a, b), ca.SX(3.0), b]
    function = ca.Function("f", [a, b], [ca.vertcat(*terms)])
    assert_casadis(function, [(0, 0), (0, 1)], 0.05, 0.95)


def test_of_values_that_several_others_share() -> None:
    x, y = ca.SX.sym("x", 3), ca.SX.sym("y", 2)
    inner = ca.sin(x[0] * x[1]) + y[0]
    outer = ca.vertcat(inner * x[2], inner**2 / y[1], inner, x[0], 1.5, y[1] * y[1] - inner)
    function = ca.Function("f", [x, y], [outer, ca.vertcat(inner * inner, x[2])])
    assert_casadis(function, [(0, 0), (0, 1), (1, 0), (1, 1)], 0.3, 1.2)


def test_nothing_of_what_is_not_asked_for_is_left() -> None:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    function = ca.Function("f", [x, y], [ca.vertcat(2.0 * x + ca.exp(y), ca.cos(y))])
    alone = derivatives(operations_of(function), [(0, 0)])
    assert len(alone.rows) == 0
    assert alone.patterns[0].nnz() == 1
    (there,) = values(alone, [np.ones(1), np.ones(1)])
    np.testing.assert_array_equal(there, [[2.0], [0.0]])


@pytest.mark.parametrize("topology", [PLAIN, FRICTIONAL, RUBBER], ids=["plain", "frictional", "rubber"])
def test_of_an_axle_they_have_casadis_places_and_fewer_operations(topology: Topology) -> None:
    eq = assemble(topology)
    symbols = [eq.x, eq.c, eq.u, eq.z]
    whole = operations_of(ca.Function("whole", symbols, [ca.densify(eq.residual), ca.densify(eq.outputs)]))
    blocks = [(0, 0), (0, 1), (1, 0)]
    own = derivatives(whole, blocks)
    casadis = [
        ca.jacobian(part, s) for part, s in ((eq.residual, eq.x), (eq.residual, eq.c), (eq.outputs, eq.x))
    ]
    assert [own.patterns[k] for k in range(3)] == [block.sparsity() for block in casadis]
    assert len(own.rows) < 0.95 * len(operations_of(ca.Function("casadis", symbols, casadis)).rows)
    rng = np.random.default_rng(7)
    at = [rng.uniform(0.01, 0.02, s.numel()) for s in symbols]
    expected = ca.Function("e", symbols, casadis).call([ca.DM(a) for a in at])
    for found, there in zip(values(own, at), expected, strict=True):
        dense = np.array(there)
        np.testing.assert_allclose(found, dense, rtol=1e-8, atol=1e-9 * np.abs(dense).max())
