"""Designs side by side: what each gives alone, whatever its neighbours do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle import Axle
from doe_kc.axle.parameters import ParameterMap
from doe_kc.axle.places import places_of
from doe_kc.axle_file import read_axle
from doe_kc.effects import EFFECTS, apply_effect
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases.vertical import Vertical
from doe_kc.solver import library_on_demand
from doe_kc.solver.batch_library import AdaptiveBatch, BatchLibrary, adaptive_batch, batch_library
from doe_kc.solver.batch_suite import RESPONSE_COLUMNS, BatchSolution, solve_batch
from doe_kc.solver.instructions import InstructionSet, own_instruction_set
from doe_kc.solver.library import find_compiler
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from tests.reference import nominal

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
QUICKLY_COMPILED = InstructionSet(4, (*own_instruction_set().flags, "-O0"), own_instruction_set().library)
"""Of a library that serves one test."""
DESIGNS = 5
CLOSE = 1e-9
PATHS = ("WLC.z", "WLC.y", "spring.rate", "tyre.static_load")
NOMINAL = "mcpherson_front"
OPTIONS: dict[str, dict[str, object]] = {
    "hub_compliance": {"law": "stiffening", "loaded_factor": 1.4, "reference_Nm": 100.0},
    "strut_bending": {"law": "stiffening", "loaded_factor": 0.7, "reference_Nm": 150.0},
}
"""Of effects whose default leaves a law out."""
FRICTION = ("strut_friction", "steering_friction", "rubber_hysteresis", "damper_friction")


def axle_of(name: str) -> Axle:
    return read_axle(example_folder(name) / "axle.toml")


def with_effects(name: str, *, friction: bool) -> Axle:
    """The example of a type with every effect that it can have: those without friction, or with; of a type
    other than the nominal one, those that the nominal one cannot have."""
    axle, known = axle_of(name), places_of(nominal())
    for ident, effect in EFFECTS.items():
        here = effect.possible(places_of(axle)) and (name == NOMINAL or not effect.possible(known))
        if here and (ident in FRICTION) == friction:
            axle = apply_effect(axle, ident, OPTIONS.get(ident, {}), source="test")
    return axle


EFFECTS_OF = {
    (name, friction): with_effects(name, friction=friction)
    for name in (NOMINAL, "double_wishbone_front")
    for friction in (False, True)
}


def scattered(axle: Axle, count: int = DESIGNS) -> dict[str, FloatArray]:
    """Internal values of designs around the axle."""
    rng = np.random.default_rng(5)
    parameters = ParameterMap(axle, PATHS)
    base = np.array([abs(axle.values.get(f"{p}@L", axle.values.get(p, 0.0))) for p in PATHS])
    shifts = np.array([2.0, 2.0, 0.03 * base[2], 0.03 * base[3]]) * rng.normal(size=(count, len(PATHS)))
    start = np.array([axle.values.get(f"{p}@L", axle.values.get(p, 0.0)) for p in PATHS])
    return parameters.changes(start + shifts)


def one_by_one(axle: Axle, changes: dict[str, FloatArray]) -> Iterator[Solution]:
    for i in range(len(next(iter(changes.values())))):
        yield solve(axle.changed({name: float(v[i]) for name, v in changes.items()}), throw=False)


def assert_the_same(axle: Axle, changes: dict[str, FloatArray], found: BatchSolution) -> None:
    for i, alone in enumerate(one_by_one(axle, changes)):
        assert alone.failure is None and not found.failed[i]
        columns = [alone.column(name) for name in RESPONSE_COLUMNS]
        for ident, (_, branches) in found.cases.items():
            for one, other in zip(branches, alone.cases[ident].branches, strict=True):
                np.testing.assert_array_equal(one.input, other.input)
                np.testing.assert_allclose(one.y[i], other.y[:, columns], rtol=CLOSE, atol=CLOSE)


@pytest.fixture(scope="module")
def library() -> BatchLibrary:
    return batch_library(nominal().topology)


@pytest.mark.parametrize("name", EXAMPLE_TYPES)
def test_every_type_side_by_side_is_every_design_alone(name: str) -> None:
    axle = axle_of(name)
    wheel = Vertical(amplitude=60.0, steps=16, control="wheel")
    axle = replace(
        axle, load_cases={**axle.load_cases, "vertical": wheel} if "five" in name else axle.load_cases
    )
    changes = scattered(axle)
    assert_the_same(axle, changes, solve_batch(axle, changes, adaptive_batch(axle.topology)))


@pytest.mark.parametrize("which", EFFECTS_OF, ids=lambda w: f"{w[0]}, {'friction' if w[1] else 'elastic'}")
def test_every_effect_side_by_side_is_every_design_alone(which: tuple[str, bool]) -> None:
    axle = EFFECTS_OF[which]
    assert axle.topology.frictional == which[1]
    changes = scattered(axle, 3 if which[1] else DESIGNS)
    assert_the_same(axle, changes, solve_batch(axle, changes, adaptive_batch(axle.topology)))


def test_the_effects_of_these_tests_are_all_that_there_are() -> None:
    assert {ident for axle in EFFECTS_OF.values() for ident in axle.effects} == set(EFFECTS)


def of_friction() -> Axle:
    """Of the reference axle, all with friction."""
    return EFFECTS_OF[NOMINAL, True]


@pytest.mark.parametrize("axle", [nominal, of_friction])
def test_programs_give_the_digits_of_compiled_code(
    axle: Callable[[], Axle], library: BatchLibrary, monkeypatch: pytest.MonkeyPatch
) -> None:
    topology, changes = axle().topology, scattered(axle(), 3)
    quick = topology.frictional
    compiled = batch_library(topology, QUICKLY_COMPILED) if quick else library
    monkeypatch.setattr(library_on_demand, "stored_library", lambda *_: None)
    programs = AdaptiveBatch(topology, QUICKLY_COMPILED if quick else own_instruction_set())
    assert not programs.compiled
    one, other = (solve_batch(axle(), changes, own) for own in (compiled, programs))
    for ident, (_, branches) in one.cases.items():
        for mine, theirs in zip(branches, other.cases[ident][1], strict=True):
            np.testing.assert_array_equal(mine.y, theirs.y)


def test_no_digit_depends_on_the_neighbours(library: BatchLibrary) -> None:
    axle = nominal()
    changes = scattered(axle, 2 * library.lanes + 3)
    together = solve_batch(axle, changes, library)
    for i in (0, library.lanes + 1, 2 * library.lanes + 2):
        alone = solve_batch(axle, {name: v[[i]] for name, v in changes.items()}, library)
        for ident, (_, branches) in alone.cases.items():
            for one, other in zip(branches, together.cases[ident][1], strict=True):
                np.testing.assert_array_equal(one.y[0], other.y[i])


def test_failures_leave_their_neighbours_alone(library: BatchLibrary) -> None:
    axle = nominal()
    changes = scattered(axle, 6)
    sound = solve_batch(axle, changes, library)
    assert not sound.failed.any()
    broken = {name: v.copy() for name, v in changes.items()}
    broken["tyre.static_load"][1] = np.nan
    broken["spring.rate@L" if "spring.rate@L" in broken else "spring.rate"][3] = 1e-3
    broken["WLC.z@L"][4] += 3000.0
    found = solve_batch(axle, broken, library)
    assert found.failed[1] and not found.failed[[0, 2, 5]].any()
    for ident, (_, branches) in sound.cases.items():
        for one, other in zip(branches, found.cases[ident][1], strict=True):
            np.testing.assert_array_equal(one.y[[0, 2, 5]], other.y[[0, 2, 5]])


def test_four_lanes_give_what_the_own_number_gives(library: BatchLibrary) -> None:
    axle = nominal()
    changes = scattered(axle)
    portable = adaptive_batch(axle.topology, InstructionSet(4, ("-O0",), False))
    one, other = solve_batch(axle, changes, library), solve_batch(axle, changes, portable)
    for ident, (_, branches) in one.cases.items():
        for mine, theirs in zip(branches, other.cases[ident][1], strict=True):
            np.testing.assert_allclose(mine.y, theirs.y, rtol=CLOSE, atol=CLOSE)
