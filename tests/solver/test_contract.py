"""What every registered unit owes: an id, a datasheet, units, a place in the order, and tests of its own.

A new element, effect, load case or characteristic without them fails here.
"""

from __future__ import annotations

import ast
import importlib
import inspect
from pathlib import Path

import numpy as np
import pytest

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import RESPONSE_LABELS, RESPONSE_UNITS
from doe_kc.load_cases import CASE_ORDER, LOAD_CASES, Datum
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.solver import elements
from doe_kc.solver.elements.responses import AXLE_OUTPUT_UNITS, OUTPUT_UNITS
from tests.reference import DATA
from tests.reference import MCPHERSON_EFFECTS as EFFECTS

HERE = Path(__file__).parent
PACKAGE = Path(elements.__file__).parent
UNITS = {"mm", "N", "Nm", "deg", "Nm/deg", "N/mm", "-", ""}
WITHOUT_REFERENCE_DATA = {
    *("steer_arm_compliance", "tie_rod_compliance", "ball_joint_compliance", "anti_roll_bar_link_compliance"),
    *("power_assist", "rubber_hysteresis", "steering_ratio", "roll_technique"),
    *("rig_channel_gain", "rig_channel_offset", "rig_input_gain"),
}
"""The reference has no such effect: its own tests are hand formulas and the limit without it."""


def element_modules() -> list[str]:
    return sorted(p.stem for p in PACKAGE.glob("*.py") if not p.stem.startswith("_"))


@pytest.mark.parametrize("name", element_modules())
def test_every_element_module_has_a_test_module_that_uses_it(name: str) -> None:
    file = HERE / "elements" / f"test_{name}.py"
    assert file.exists(), f"write {file.relative_to(HERE)}: hand formulas for the element alone"
    tree = ast.parse(file.read_text())
    imported = {
        f"{node.module}.{a.name}"
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for a in node.names
    }
    assert any(i.startswith(f"doe_kc.solver.elements.{name}") for i in imported)
    assert sum(isinstance(n, ast.FunctionDef) and n.name.startswith("test_") for n in tree.body) >= 2


@pytest.mark.parametrize("name", element_modules())
def test_every_element_module_is_a_datasheet(name: str) -> None:
    module = importlib.import_module(f"doe_kc.solver.elements.{name}")
    assert module.__doc__
    for _, cls in inspect.getmembers(module, inspect.isclass):
        if cls.__module__ == module.__name__:
            assert cls.__doc__


def test_every_load_case_is_listed_in_the_order_under_its_own_name() -> None:
    assert set(LOAD_CASES) == set(CASE_ORDER)
    assert [case.id for case in LOAD_CASES.values()] == list(LOAD_CASES)
    modules = {ident: type(case).__module__.rpartition(".")[2] for ident, case in LOAD_CASES.items()}
    assert modules == {
        ident: ident if ident in ("vertical", "roll", "steer") else "force" for ident in LOAD_CASES
    }


@pytest.mark.parametrize(
    "case", [*LOAD_CASES.values(), ROLL_TECHNIQUES["counter_phase"]], ids=lambda c: type(c).__name__
)
def test_a_load_case_says_what_it_sweeps(case) -> None:
    assert type(case).__doc__
    for text in (case.label, case.channel, case.unit, case.input_label):
        assert text
    assert case.unit in UNITS
    assert 0 < case.window <= case.amplitude
    inputs = case.inputs()
    assert 0.0 in inputs
    assert len(inputs) == 2 * case.steps + 1
    assert np.all(np.diff(inputs) > 0)
    loop = case.loop_inputs()
    assert set(inputs) <= set(loop) and np.all(np.diff(loop) > 0)
    np.testing.assert_allclose(loop, -loop[::-1])
    assert len(loop) == len(inputs) + 4 and np.sum(loop > inputs[-2]) == 3
    # at input 0 nothing has moved from the static state
    static = Datum((1.0, 2.0), (310.0, 311.0), 4000.0, 790.0, 52.0)
    still = case.controls(np.zeros(1), static)
    for name, value in still.items():
        held = {"pad_L": 1.0, "pad_R": 2.0, "wc_z_L": 310.0, "wc_z_R": 311.0, "lateral_offset": value}
        assert float(np.ravel(value)[0]) == held.get(name, 0.0)


def test_the_sweeps_are_those_of_the_reference() -> None:
    amplitudes = {i: c.amplitude for i, c in LOAD_CASES.items()}
    assert amplitudes.pop("vertical") == 80.0
    assert amplitudes.pop("roll") == 4.0
    assert amplitudes.pop("steer") * 52.0 / 360.0 == pytest.approx(60.0)
    assert set(amplitudes.values()) == {2000.0}


@pytest.mark.parametrize("ident", CHARACTERISTICS)
def test_a_characteristic_names_what_it_reads(ident: str) -> None:
    entry = CHARACTERISTICS[ident]
    assert entry.id == ident
    assert ident.startswith(f"{entry.load_case}.") or entry.kind == "static"
    assert entry.load_case in LOAD_CASES or entry.kind == "static"
    assert entry.response in RESPONSE_UNITS
    for text in (entry.label, entry.symbol, entry.unit):
        assert text.strip() == text != ""
    numerator = entry.unit.split("/")[0]
    assert numerator == ("%" if entry.unit == "%" else RESPONSE_UNITS[entry.response])


def test_every_response_has_unit_label_and_output() -> None:
    assert set(RESPONSE_UNITS) == set(RESPONSE_LABELS)
    assert {n: OUTPUT_UNITS[n] for n in RESPONSE_UNITS} == dict(RESPONSE_UNITS)
    assert not set(OUTPUT_UNITS) & set(AXLE_OUTPUT_UNITS)


@pytest.mark.parametrize("ident", EFFECTS)
def test_every_effect_is_a_datasheet_with_reference_data_or_a_stated_reason(ident: str) -> None:
    effect = EFFECTS[ident]
    assert effect.id == ident == type(effect).__module__.rpartition(".")[2]
    assert type(effect).__doc__
    assert importlib.import_module(type(effect).__module__).__doc__
    assert effect.label
    for key, option in effect.options.items():
        assert option.unit in UNITS
        if isinstance(option.default, float) and option.unit not in {"", "-"}:
            suffix = {"Nm/deg": "_Nm_deg", "N/mm": "_N_mm", "mm": "_mm", "N": "_N", "Nm": "_Nm"}[option.unit]
            assert key.endswith(suffix), f"{key} does not carry its unit {option.unit}"
    assert (DATA / f"effect_{ident}.csv").exists() != (ident in WITHOUT_REFERENCE_DATA)


def test_every_reference_effect_exists() -> None:
    assert {p.stem.removeprefix("effect_") for p in DATA.glob("effect_*.csv")} <= set(EFFECTS)
