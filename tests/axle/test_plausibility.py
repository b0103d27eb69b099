"""Warnings name what no car has; plausible axles get none."""

from __future__ import annotations

from dataclasses import replace

import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.axle.plausibility import RANGES, axle_warnings
from tests.reference import nominal, variant


def swept(case: str, amplitude: float) -> Axle:
    cases = nominal().load_cases
    return replace(nominal(), load_cases={**cases, case: replace(cases[case], amplitude=amplitude)})


@pytest.mark.parametrize("number", [0, 1, 2, 3])
def test_a_plausible_axle_has_no_warning(number: int) -> None:
    assert axle_warnings(variant(number) if number else nominal()) == ()


@pytest.mark.parametrize(
    ("case", "amplitude", "parts"),
    [
        ("roll", 40.0, ["load case roll", "40 deg", "15"]),
        ("steer", 1500.0, ["load case steer", "1500 deg"]),
        ("vertical", 800.0, ["load case vertical", "800 mm"]),
        ("brake", 50000.0, ["load case brake", "50000 N", "3 static loads"]),
    ],
)
def test_an_absurd_sweep_is_named(case: str, amplitude: float, parts: list[str]) -> None:
    first = axle_warnings(swept(case, amplitude))[0]
    assert all(part in first for part in parts), first


def test_a_rack_that_runs_off_is_named_by_its_travel() -> None:
    (warning,) = axle_warnings(with_values(nominal(), {"steering.rack_mm_per_rev": 140.0}))
    assert "161.5 mm" in warning


@pytest.mark.parametrize("name", ["LLF", "ROB", "UPB", "RIB"])
def test_a_hardpoint_in_metres_is_named(name: str) -> None:
    metres = {f"{name}.{a}": nominal().values[f"{name}.{a}@L"] / 1000.0 for a in "xyz"}
    found = axle_warnings(with_values(nominal(), metres))
    assert found[0].startswith(f"hardpoint {name} (left)")
    assert "unit" in found[0]


def test_a_bushing_in_the_wrong_unit_is_named() -> None:
    found = axle_warnings(with_values(nominal(), {"llr.stiffness.Fx": 1.5e-3}))
    assert [w.split(" has")[0] for w in found] == ["bushing llr (left)"]


def test_a_side_of_its_own_is_named() -> None:
    found = axle_warnings(with_values(nominal(), {"right.spring.rate": 2800.0}))
    assert [w.split(" is")[0] for w in found] == ["spring.rate (right)"]


def test_every_range_has_a_reason_and_holds_the_example() -> None:
    for entry in RANGES:
        assert entry.lower < entry.value(nominal(), "L") < entry.upper
        assert entry.reason
