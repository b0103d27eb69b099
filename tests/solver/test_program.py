"""Straight-line programs: every operation, patterns, the cache, threads; digit for digit what C computes."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from doe_kc.axle import Axle
from doe_kc.effects import apply_effect
from doe_kc.solver import compiled, library_on_demand
from doe_kc.solver.compiled import AdaptiveKernel, adaptive_kernel
from doe_kc.solver.derivative_library import derivative_library
from doe_kc.solver.dialect import EXPRESSIONS
from doe_kc.solver.kernel import Buffered, interpreted_functions, kernel, kernel_programs
from doe_kc.solver.library import CACHE_VARIABLE, CompileError, find_compiler
from doe_kc.solver.program import Program, program_of, programs_bytes, read_programs
from doe_kc.solver.program_library import ProgramFunction, march_library, programs_for, sensitivity_library
from doe_kc.solver.suite import solve
from tests.reference import nominal

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
TOPOLOGY = nominal().topology
FRICTION = ("strut_friction",)


def axle_with(effects: tuple[str, ...]) -> Axle:
    axle = nominal()
    for ident in effects:
        axle = apply_effect(axle, ident, {}, source="test")
    return axle


def of_expressions(*expressions: ca.SX, symbols: tuple[ca.SX, ...]) -> ca.Function:
    return ca.Function("f", list(symbols), list(expressions))


def test_every_operation_is_casadis() -> None:
    a, b = ca.SX.sym("a"), ca.SX.sym("b")
    unary = [ca.sqrt, ca.exp, ca.log, ca.sin, ca.cos, ca.tan, ca.asin, ca.acos, ca.atan, ca.sinh, ca.cosh]
    unary += [ca.tanh, ca.asinh, ca.atanh, ca.log1p, ca.expm1, ca.fabs, ca.sign, ca.floor, ca.ceil, ca.erf]
    binary = [ca.fmin, ca.fmax, ca.atan2, ca.hypot, ca.copysign, ca.fmod, ca.power, ca.remainder]
    terms = [operation(a) for operation in unary] + [operation(a, b) for operation in binary]
    terms += [a + b, a - b, a * b, a / b, -a, a * a, 1 / a, 2 * a, ca.acosh(1 + a), a**3.5]
    terms += [a < b, a <= b, a == b, a != b, ca.logic_not(a), ca.if_else(a > 0.3, b, a)]
    terms += [ca.logic_and(a > 0.3, b > 0.3), ca.logic_or(a > 0.3, b > 0.3)]
    function = of_expressions(ca.vertcat(*terms), symbols=(a, b))
    used = {function.instruction_id(k) for k in range(function.n_instructions())}
    assert len(used & EXPRESSIONS.keys()) > 35
    own, expected = ProgramFunction(program_of(function)), Buffered(function)
    for point in np.random.default_rng(1).uniform(0.05, 0.95, (20, 2)):
        pair = (point[:1], point[1:])
        np.testing.assert_allclose(own(*pair), expected(*pair), rtol=1e-14, atol=1e-15)


def test_results_may_be_arguments_constants_or_nothing() -> None:
    x = ca.SX.sym("x", 2)
    function = of_expressions(ca.vertcat(x[1], 3.0, x[0] + x[1]), symbols=(x, ca.SX.sym("y", 0)))
    np.testing.assert_array_equal(
        ProgramFunction(program_of(function))(np.array([1.0, 2.0]), np.zeros(0)), [2, 3, 3]
    )
    assert ProgramFunction(program_of(of_expressions(ca.SX(0, 1), symbols=(x,))))(np.ones(2)).size == 0


def test_no_value_is_computed_twice_and_places_are_shared() -> None:
    function = interpreted_functions(TOPOLOGY)["jacobian"]
    own = program_of(function)
    assert own.length < function.n_instructions()
    rows = np.repeat(own.runs[:, 0], own.runs[:, 1])
    assert len(rows) == own.length > 20 * len(own.runs)
    assert own.places[0] < own.length / 4
    assert own.pattern(0) == function.sparsity_out(0)


@pytest.mark.parametrize(
    ("expression", "operations"),
    [
        (lambda a, b, c: [a * b + c], 1),
        (lambda a, b, c: [c + a * b], 1),
        (lambda a, b, c: [a * b - c], 1),
        (lambda a, b, c: [c - a * b], 1),
        (lambda a, b, c: [a * b + b * c], 2),
        (lambda a, b, c: [a * b - b * c], 2),
        (lambda a, b, c: [(a * b + c) * c - b], 2),
        (lambda a, b, c: [a * b + c, a * b - c], 3),
        (lambda a, b, c: [a * b + c, a * b], 2),
    ],
)
def test_a_product_that_one_sum_alone_reads_is_computed_with_it(
    expression: Callable[..., list[ca.SX]], operations: int
) -> None:
    """With the digits of both: each is rounded."""
    symbols = tuple(ca.SX.sym(name) for name in "abc")
    program = program_of(of_expressions(ca.vertcat(*expression(*symbols)), symbols=symbols))
    assert program.length == operations
    for point in np.random.default_rng(2).uniform(-1.0, 1.0, (50, 3)):
        expected = expression(*point)
        np.testing.assert_array_equal(ProgramFunction(program)(*point[:, None]), expected)


@pytest.mark.parametrize("name", ["residual", "jacobian", "outputs", "state_update"])
def test_the_functions_of_a_topology_are_the_interpreted_ones(name: str) -> None:
    topology = replace(TOPOLOGY, strut_friction="dahl")
    function = interpreted_functions(topology)[name]
    rng = np.random.default_rng(5)
    k = kernel(topology)
    c = k.constant_values(dict(axle_with(("strut_friction",)).values))
    at = [rng.uniform(-0.01, 0.01, k.nx), c, rng.uniform(0.5, 1.0, k.nu), rng.uniform(-0.01, 0.01, k.nz)]
    own = ProgramFunction(kernel_programs(topology)[name])
    expected = Buffered(function)(*at)
    assert np.isfinite(expected).all()
    np.testing.assert_allclose(own(*at), expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())


def test_programs_are_read_as_they_were_written() -> None:
    own = {name: kernel_programs(TOPOLOGY)[name] for name in ("residual", "constants")}
    again = read_programs(programs_bytes(own))
    assert list(again) == list(own)
    for name, program in own.items():
        for field in fields(Program):
            np.testing.assert_array_equal(getattr(again[name], field.name), getattr(program, field.name))


@pytest.mark.parametrize("keep", [0, 100, 0.5, 0.99])
def test_damaged_programs_are_made_anew(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, keep: float) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    x = ca.SX.sym("x")
    asked = []

    def made() -> dict[str, Program]:
        asked.append(1)
        return {"f": program_of(of_expressions(ca.sin(x) + 1, symbols=(x,)))}

    for _ in range(2):
        programs_for(TOPOLOGY, "test", made)
    assert len(asked) == 1
    (stored,) = tmp_path.glob("*.npz")
    whole = stored.read_bytes()
    stored.write_bytes(whole[: int(keep if keep >= 1 else keep * len(whole))])
    assert programs_for(TOPOLOGY, "test", made)["f"].length == 2
    assert len(asked) == 2
    assert read_programs(stored.read_bytes())["f"].length == 2


def test_threads_do_not_disturb_each_other() -> None:
    expected = solve(nominal(), ["vertical"]).cases["vertical"].branches[0].y
    gaps: list[float] = []

    def work() -> None:
        for _ in range(10):
            own = solve(nominal(), ["vertical"]).cases["vertical"].branches[0].y
            gaps.append(float(np.abs(own - expected).max()))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert gaps == [0.0] * 40


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A cache without compiled libraries; the second call compiles."""
    for library in (march_library, sensitivity_library):
        library()  # from the cache that has it
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(library_on_demand, "OPERATIONS_BEFORE_COMPILING", 1)
    caches = (compiled.compiled_kernel, adaptive_kernel, derivative_library, kernel)
    for cache in caches:
        cache.cache_clear()
    yield
    for cache in caches:
        cache.cache_clear()


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("effects", [(), FRICTION], ids=["plain", "friction"])
def test_what_is_asked_for_often_is_compiled_with_the_same_digits(
    effects: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    axle = axle_with(effects)

    def run() -> list[np.ndarray]:
        solution = solve(axle, ["vertical", "lateral"])
        return [part for case in solution.cases.values() for b in case.branches for part in (b.x, b.y, b.z)]

    with monkeypatch.context() as patch:
        patch.setattr(library_on_demand, "OPERATIONS_BEFORE_COMPILING", 10**12)
        programs = run()
        assert not adaptive_kernel(axle.topology).compiled
    for expected, own in zip(programs, run(), strict=True):
        np.testing.assert_array_equal(own, expected)
    assert adaptive_kernel(axle.topology).compiled
    assert AdaptiveKernel(axle.topology).compiled
    assert kernel(axle.topology).constants is not None


@pytest.mark.usefixtures("impatient")
def test_where_compiling_fails_the_programs_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object) -> None:
        raise CompileError("license expired")

    monkeypatch.setattr(compiled, "library_of", fails)
    first, second = (solve(nominal(), ["lateral"]) for _ in range(2))
    assert not adaptive_kernel(TOPOLOGY).compiled
    np.testing.assert_array_equal(first.cases["lateral"].branches[0].y, second.cases["lateral"].branches[0].y)
