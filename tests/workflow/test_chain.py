"""The whole chain on cars whose truth is known: one axle, and whether it can be used."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.correlation.assessment import harmed, inside
from doe_kc.correlation.result import Correlation
from doe_kc.correlation.twin_agreement import TwinAgreement
from doe_kc.discovery.result import Discovery
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.true_solver.options import SolverOptions
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.answer import answer_lines, answer_record, answered, summary_document, write_answer
from doe_kc.workflow.chain import ADVICE, DIFFERENT, NO_TWIN, TWIN_ADVICE, describes_the_same, follow_chain
from doe_kc.workflow.correlate import correlate
from doe_kc.workflow.correlation_problem import study_problem
from doe_kc.workflow.measure import Reduced
from tests.discovery.cases import discovery, nominal
from tests.workflow.chain_cases import answer, reduced, study

ENTRY = {
    "name", "unit", "target", "sd", "baseline", "final", "low", "high", "held", "reachable", "role",
    "improvement_percent",
}  # fmt: skip


@pytest.mark.parametrize("car", ["named", "pair", "none"])
def test_where_the_effects_are_named_the_axle_is_sound(car: str) -> None:
    found = answer(car)
    assert found.assessment.status == "sound", found.assessment.reasons
    assert found.correlation.mean_improvement > 95.0
    assert all(inside(e) for e in found.correlation.improvements)
    assert found.gap is not None and found.gap.final < 1.1
    effects = set(found.correlation.axle.effects)
    assert effects == {f.hypothesis.effect for f in discovery(car).findings}


@pytest.mark.parametrize("car", ["named", "class", "unexplained", "lead", "two", "none"])
def test_nothing_that_was_measured_is_harmed(car: str) -> None:
    found = answer(car)
    assert found.assessment.status != "not_usable", found.assessment.reasons
    assert not any(harmed(e) for e in found.correlation.improvements)
    assert found.correlation.best.harmless


def test_without_the_effect_the_axle_is_no_worse_and_called_doubtful() -> None:
    """Forced on the car, the targets of the missing effect would bend everything else."""
    found = answer("named", "never")
    assert found.assessment.status == "doubtful"
    assert not any(harmed(e) for e in found.correlation.improvements)
    assert any("hub and wheel-bearing compliance" in r for r in found.assessment.reasons)


def test_a_class_is_doubtful_and_names_the_others() -> None:
    found = answer("class")
    assert found.assessment.status == "doubtful"
    (sentence,) = [r for r in found.assessment.reasons if "leading one of a class" in r]
    assert "it could be" in sentence


def test_what_nothing_explains_is_said() -> None:
    found = answer("unexplained")
    assert found.assessment.status == "doubtful"
    assert any("nothing explains" in r for r in found.assessment.reasons)


def test_effects_that_came_with_the_axle_and_the_baseline_that_was_handed_in() -> None:
    """Improvements are counted from the study's axle, not from the extended one."""
    found = answer("named")
    correlation = found.correlation
    assert correlation.given is not None and correlation.baseline is correlation.given
    plain = answer("named", "never").correlation
    before = [e.baseline for e in correlation.improvements]
    assert before == pytest.approx([e.baseline for e in plain.improvements], rel=1e-9)


def test_the_answer_at_the_top_of_the_folder(tmp_path: Path) -> None:
    plain, found = study(tmp_path), answer("named")
    plain = replace(plain, out=tmp_path / "out")
    record = answer_record(found, 12.0)
    paths = write_answer(plain, found.correlation, found.assessment, record, reduced("named").measurement)
    assert [p.relative_to(tmp_path / "out").name for p in paths] == [
        "axle.toml",
        "summary.json",
        "index.html",
        "summary.pdf",
        "report.html",
    ]
    first = paths[0].read_text().splitlines()[0]
    assert first.startswith("# Written by doe_kc") and "Sound: " in first
    assert "hub_compliance" in first and "Rating " in first
    again = read_axle(paths[0])
    assert dict(again.values) == dict(found.correlation.axle.values)
    summary = json.loads(paths[1].read_text())
    assert summary["status"] == "sound" and summary["effects"][0]["adopted"] is True
    assert all(set(c) == ENTRY for c in summary["characteristics"])
    assert set(summary["gap"]) == {"nominal", "tuned", "final", "noise_floor", "cases"}
    cases = summary["gap"]["cases"]
    assert {"vertical", "lateral", "static"} <= set(cases)
    assert all(case["final"] < 1.5 for case in cases.values())
    assert paths[3].read_bytes().startswith(b"%PDF") and record.words[0].adopted
    assert 'href="simulate/report.html"' in paths[2].read_text()
    assert (
        "Sound" in paths[2].read_text() and answer_lines(found.assessment, record)[0] == found.assessment.line
    )


def test_the_gap_of_the_answer_is_that_of_its_axle(tmp_path: Path) -> None:
    found = answer("named")
    document = summary_document(found.correlation, found.assessment, answer_record(found, 1.0), "axle.toml")
    gap = document["gap"]
    assert gap["nominal"] > gap["tuned"] > gap["final"]
    assert gap["final"] == pytest.approx(discovery("named").gap.with_effect, rel=0.1)
    worse = replace(found.correlation, run=replace(found.correlation.run, best=0))
    other = answered(study(tmp_path), reduced("named").measurement, worse, found.discovery, found.adoption)
    assert other.gap is not None and other.gap.final > gap["final"]


OUTSIDE = SolverOptions.model_validate({"command": ["solve"]})


def with_outside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, alike: bool) -> tuple[list[str], tuple]:
    """The chain of a study with an outside solver, and which steps were made with what."""
    outside = replace(study(tmp_path), solver=OUTSIDE, axle=nominal())
    monkeypatch.setattr("doe_kc.workflow.chain.describes_the_same", lambda *_: alike)
    made: list[str] = []

    def discover(own, _measurement):  # type: ignore[no-untyped-def]
        made.append(f"discover with {own.solver.command or 'own'}")
        return discovery("named")

    def correlated(_study, _reduced, adoption):  # type: ignore[no-untyped-def]
        made.append(f"correlate with {adoption}")
        return answer("named", "never").correlation

    found = follow_chain(outside, reduced("named"), discover, correlated)
    return made, found.assessment.reasons


def test_an_outside_model_is_advised_where_the_axle_file_describes_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, reasons = with_outside(tmp_path, monkeypatch, alike=True)
    assert made == ["discover with own", "correlate with None"]
    assert ADVICE in reasons and any("the outside model does not have it" in r for r in reasons)


def test_an_outside_model_of_another_car_is_not_discovered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, reasons = with_outside(tmp_path, monkeypatch, alike=False)
    assert made == ["correlate with None"] and DIFFERENT in reasons


@pytest.mark.parametrize("share", [0.99, 0.1])
def test_an_outside_model_with_a_twin_is_correlated_first_and_advised_through_it(
    tmp_path: Path, share: float
) -> None:
    outside = replace(study(tmp_path), solver=OUTSIDE, axle=nominal(), twin=nominal())
    made: list[str] = []

    def discover(own: Study, records: Measurement) -> Discovery:
        made.append("discover")
        assert own.solver.command == [] and own.twin is None and "in its own terms" in own.discovery_remark
        assert set(records.curves.cases) == set(nominal().load_cases)
        return discovery("named")

    def correlated(_study: Study, _reduced: Reduced, adoption: Adoption | None) -> Correlation:
        made.append(f"correlate with {adoption}")
        return replace(answer("named", "never").correlation, twin=TwinAgreement((), share, None))

    found = follow_chain(outside, reduced("named"), discover, correlated)
    if share > 0.5:
        assert made == ["correlate with None", "discover"]
        assert TWIN_ADVICE in found.assessment.reasons and found.ground is not None
    else:
        assert made == ["correlate with None"]
        assert NO_TWIN in found.assessment.reasons and found.ground is None


def test_whether_two_solvers_describe_the_same_axle(tmp_path: Path) -> None:
    assert describes_the_same(study(tmp_path), reduced("named"))


def test_only_load_cases_that_the_outside_solver_answers_have_targets(tmp_path: Path) -> None:
    few = OUTSIDE.model_copy(update={"load_cases": ["vertical", "steer"]})
    problem = study_problem(replace(study(tmp_path), solver=few), reduced("named"))
    cases = {t.entry.load_case for t in problem.targets.characteristics}
    assert cases == {"static", "vertical", "steer"}
    assert {c.load_case for c in (*problem.targets.curves, *problem.targets.others)} == {"vertical", "steer"}
    assert {c.load_case for c in problem.likelihood.curves} == {"vertical", "steer"}


def test_the_thesis_objective_works_on_its_own_terms(tmp_path: Path) -> None:
    plain = study(tmp_path)
    options = plain.correlation.model_copy(update={"objective": "thesis", "budget": 12})
    found = correlate(replace(plain, correlation=options), reduced("none"), workers=1)
    assert found.problem.search.misfit is None
    counted = [c.objective is not None for c in found.problem.search.characteristics]
    assert counted == [c.objective is not None for c in found.problem.targets.characteristics]
    assert np.isfinite(found.rating) and found.rating > found.baseline_rating
