"""The steps of a study: what they hand on, print and write."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import design_parameters
from doe_kc.axle_file import read_axle
from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.output import write_json
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from doe_kc.study import Study, read_study
from doe_kc.targets.comparison import Comparison
from doe_kc.workflow.compare import compare_model, comparison_document, comparison_lines
from doe_kc.workflow.influence import influence_runs, study_influence
from doe_kc.workflow.measure import Reduced, reduce_records, reduced_document, vertical_scatter
from tests.cli.runner import write_study
from tests.reference import nominal


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Two parameters, one load case."""
    folder = tmp_path_factory.mktemp("study")
    records = {"lateral": ("lateral.csv", "lateral_repeat1.csv")}
    return read_study(write_study(folder, records=records, parameters=["LLF.z", "llr.Fy"]))


@pytest.fixture(scope="module")
def solution(study: Study) -> Solution:
    return solve(study.axle, compiled=False)


@pytest.fixture(scope="module")
def reduced(study: Study, solution: Solution) -> Reduced:
    return reduce_records(study, solution)


@pytest.fixture(scope="module")
def comparison(study: Study, solution: Solution, reduced: Reduced) -> Comparison:
    return compare_model(study, curve_set(solution), reduced.measurement)


def test_without_a_vertical_record_there_is_no_ride_height(reduced: Reduced) -> None:
    assert reduced.ride_height is None
    document = reduced_document(reduced)
    assert document["ride_height_mm"] is None and document["name"] == "small"
    entry = document["characteristics"]["lateral.toe_change"]
    assert set(entry) == {"value", "sd", "unit", "load_case"} and entry["load_case"] == "lateral"


def test_targets_bring_their_standard_deviation(reduced: Reduced, comparison: Comparison) -> None:
    for row in comparison.characteristics:
        assert row.target == pytest.approx(reduced.measurement.characteristics[row.entry.id].value, rel=1e-9)
        assert row.target_sd == reduced.measurement.characteristics[row.entry.id].sd
    assert {r.entry.load_case for r in comparison.characteristics} == {"static", "lateral"}


def test_the_table_for_a_terminal(comparison: Comparison) -> None:
    lines = comparison_lines(comparison)
    assert len(lines) == len(comparison.characteristics) + 2
    for line, row in zip(lines[1:-1], comparison.characteristics, strict=True):
        assert line.startswith(row.entry.id) and ("*" in line) == (not row.inside)
        assert line.endswith(row.entry.unit)
    outside = sum("*" in line for line in lines[1:-1])
    assert lines[-1].startswith(f"{outside} of {len(comparison.characteristics)} outside")


def test_the_document_is_json(comparison: Comparison, tmp_path: Path) -> None:
    document = comparison_document(comparison)
    again = json.loads(write_json(tmp_path / "c.json", document).read_text())
    assert len(again["characteristics"]) == len(comparison.characteristics)
    assert {c["response"] for c in again["curves"]} == set(RIG_RESPONSES)


def test_the_studys_window_is_used_for_both(
    study: Study, solution: Solution, reduced: Reduced, comparison: Comparison
) -> None:
    narrow = replace(study, windows={"lateral": 3000.0})
    other = compare_model(narrow, curve_set(solution), reduced.measurement)
    for ours, theirs in zip(comparison.characteristics, other.characteristics, strict=True):
        changed = ours.entry.load_case == "lateral"
        assert (ours.value != theirs.value) == changed and (ours.target != theirs.target) == changed


def test_influence_without_and_with_targets(
    study: Study, reduced: Reduced, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DOE_KC_COMPILE", "0")
    told: list[int] = []
    found = study_influence(study, reduced.measurement, workers=1, progress=told.append)
    assert sum(told) == influence_runs(study) == 5
    assert [p.path for p in found.matrix.parameters] == ["LLF.z", "llr.Fy"]
    assert len(found.matrix.characteristics) == 21 and len(found.everything.characteristics) == 30
    assert found.selection is not None
    few = replace(study, parameters=study.parameters[:1])
    assert study_influence(few, None, workers=1).selection is None


SET_UP = ("ride_height", "bump_stop.clearance", "rebound_stop.clearance")
"""What the search for the rig's set-up looks for, or treats by itself."""


def test_scatter_of_every_parameter() -> None:
    for parameter in design_parameters(nominal()):
        sigma = parameter.production_sd
        quiet = parameter.path in SET_UP or not parameter.active or parameter.path == "strut.flexibility"
        assert (sigma == 0) == quiet, parameter.path
        assert sigma <= max(1.0, 0.2 * abs(parameter.nominal))


def test_scatter_moves_curves_that_start_at_static(solution: Solution, study: Study) -> None:
    curves = vertical_scatter(study.axle, solution)
    case = solution.cases["vertical"]
    n = 2 * (len(case.branches[0].input) - 1) + 1
    count = sum(p.production_sd > 0 for p in design_parameters(study.axle))
    assert set(curves) == set(RIG_RESPONSES)
    for response, curve in curves.items():
        assert curve.shape == (n, count) and np.isfinite(curve).all()
        assert response == "tyre_load" or not curve[n // 2].any()


def test_the_studys_axle_is_the_file(study: Study) -> None:
    assert read_axle(study.axle_path).values == study.axle.values
