"""The tests that an answer advises, carried out on a hidden car."""

from __future__ import annotations

import json
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest

from benchmarks.discovery import running
from benchmarks.discovery.car import Car, CleanRecords
from benchmarks.discovery.cases import Case, cases, publish
from benchmarks.discovery.followup import VARIABLES, Advice, advised, carry_out
from benchmarks.discovery.generator import RECORDS, HiddenCar
from benchmarks.discovery.unsealing import followups
from doe_kc.axle_file import read_axle
from doe_kc.measurement import reduce_measurement
from doe_kc.solver.result import Failure, NotConverged
from doe_kc.variables import VariableOptions, build_space

PARTS = {"kind": "component", "effects": ["rack_mount_compliance"], "parts": ["scb.Tz", "LLF.y"]}
RUN = {
    "kind": "load_case",
    "effects": ["steer_arm_compliance", "tie_rod_compliance"],
    "load_case": "lateral_offset",
    "amplitude": 1500.0,
    "offset_mm": -30.0,
}


def test_the_best_load_case_of_each_pair_and_all_parts() -> None:
    second = RUN | {"load_case": "steer", "amplitude": 600.0, "offset_mm": None}
    more = PARTS | {"parts": ["LLF.y", "ROB.x"]}
    found = advised({"further_tests": [RUN, second, PARTS, more]})
    assert found == Advice({"lateral_offset": (1500.0, -30.0)}, ("scb.Tz", "LLF.y", "ROB.x"))
    assert not advised({"verdict": "none"})


def test_parts_are_measured_and_load_cases_driven(plain: HiddenCar, tmp_path: Path) -> None:
    carry_out(plain, advised({"further_tests": [RUN, PARTS]}), tmp_path)
    axle = read_axle(tmp_path / "axle.toml")
    case = axle.load_cases["lateral_offset"]
    assert (case.amplitude, case.offset) == (1500.0, -30.0)  # type: ignore[attr-defined]
    measured = reduce_measurement(tmp_path / RECORDS, half_track=axle.half_track)
    assert measured.curves.cases["lateral_offset"].input.max() == pytest.approx(1500.0, rel=0.01)
    assert "lateral_offset_mm = -30.0" in (tmp_path / RECORDS / "test.toml").read_text()
    told = VariableOptions.model_validate(tomllib.loads((tmp_path / VARIABLES).read_text()))
    space = build_space(axle, told, "test")
    by_path = {v.path: v for v in space.variables}
    column, point = by_path["scb.Tz"], by_path["LLF.y"]
    assert abs(column.start / plain.car.axle.values["scb.Tz"] - 1.0) < 0.07
    assert column.upper / column.lower == pytest.approx(1.06 / 0.94, rel=0.01)
    sides = [abs(plain.car.axle.values[f"LLF.y@{s}"]) for s in "LR"]
    assert abs(abs(point.start) - sum(sides) / 2.0) < 0.35
    assert point.upper - point.lower == pytest.approx(0.6)
    assert column.distribution == point.distribution == "gaussian"


def test_a_load_case_without_an_equilibrium_is_not_driven(
    plain: HiddenCar, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stuck(_: Car) -> CleanRecords:
        raise NotConverged(
            Failure("lateral_offset", "pos", 3, 1500.0, "N", 1400.0, "rack moved by 9 mm", "over-centre")
        )

    monkeypatch.setattr(Car, "clean", stuck)
    carry_out(plain, advised({"further_tests": [RUN, PARTS]}), tmp_path)
    assert read_axle(tmp_path / "axle.toml").load_cases == plain.nominal.load_cases
    assert "scb.Tz" in (tmp_path / VARIABLES).read_text()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[Case], Path]:
    chosen = cases(1, ["null", "confounded"], 5, "example")
    folder = tmp_path_factory.mktemp("run")
    publish(chosen, folder)
    return chosen, folder


@pytest.mark.parametrize(("verdict", "again"), [("named", 0), ("none", 1)])
def test_only_confounded_cars_without_a_name_are_looked_at_again(
    run: tuple[list[Case], Path], verdict: str, again: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    chosen, folder = run
    asked: list[str] = []

    def fake(command: list[str], **_: Any) -> subprocess.CompletedProcess[str]:
        asked.append(command[3])
        Path(command[4]).write_text(json.dumps({"verdict": "none", "seconds": 2.0}))
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr(running.subprocess, "run", fake)
    for case in chosen:
        place = running.answer_place(folder, case)
        place.parent.mkdir(exist_ok=True)
        place.write_text(json.dumps({"verdict": verdict, "further_tests": [PARTS]}))
    running.follow_up(chosen, folder, workers=1)
    running.follow_up(chosen, folder, workers=1)
    assert len(asked) == len(followups(chosen, folder)) == again
    assert all("followups" in seen for seen in asked)
