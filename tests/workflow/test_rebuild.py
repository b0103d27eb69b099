"""A correlation read back from its record and the store: the same, or judged by other weights."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from doe_kc.campaign.record import StoredEvaluation, design_key, packed_outcome
from doe_kc.campaign.store import open_store
from doe_kc.correlation.answer_record import AnswerRecord, GapRecord
from doe_kc.correlation.assessment import Objection
from doe_kc.correlation.record import run_document
from doe_kc.correlation.result import Correlation
from doe_kc.ground.errors import InputError
from doe_kc.ground.output import write_json
from doe_kc.reports.correlation.characteristics import characteristic_table
from doe_kc.reports.correlation.evaluations import evaluation_table
from doe_kc.reports.correlation.terms import term_columns
from doe_kc.study import Study, read_study
from doe_kc.targets import CharacteristicOptions
from doe_kc.true_solver.make import solver_for
from doe_kc.workflow.measure import Reduced
from doe_kc.workflow.rebuild import recall, write_run
from tests.correlation.cases import measured
from tests.reference import EXAMPLE
from tests.reports.correlations import CAR, ODD_WEIGHTS, odd, real


def reduced() -> Reduced:
    return Reduced(measured(CAR), None)


def read_study_of(out: Path, *weights: CharacteristicOptions) -> Study:
    """The example, written to `out`."""
    return replace(read_study(EXAMPLE, out=out), windows={}, characteristics=weights, curves=())


def kept(found: Correlation, out: Path, *weights: CharacteristicOptions) -> Study:
    """A study with the record and the evaluations of a correlation."""
    plain = read_study_of(out, *weights)
    with open_store(plain.store, solver_for(plain.axle, plain.solver)) as store:
        for e in found.run.evaluated:
            values = found.problem.space.values(e.point)
            row = StoredEvaluation(
                key=design_key(values),
                parameters=values,
                packed=packed_outcome(e.outcome),
                windows={},
                origin="test",
                created="2026-01-31",
                versions={},
            )
            store.put(row)
    write_run(found, out)
    return plain


def chosen(found: Correlation, place: int) -> Correlation:
    return replace(found, run=replace(found.run, best=place))


def ratings(found: Correlation) -> list[float]:
    return [e.rating.total if e.rating is not None else -np.inf for e in found.run.evaluated]


def test_the_same_weights_give_the_same_correlation(tmp_path: Path) -> None:
    best = recall(kept(odd(), tmp_path, *ODD_WEIGHTS), reduced(), tmp_path).correlation.run.best
    found = chosen(odd(), best)
    write_run(found, tmp_path)
    again = recall(read_study_of(tmp_path, *ODD_WEIGHTS), reduced(), tmp_path).correlation
    assert again.run.best == best
    assert ratings(again) == pytest.approx(ratings(found), rel=1e-12)
    assert again.values == found.values
    for one, other in zip(again.run.evaluated, found.run.evaluated, strict=True):
        assert (one.candidate.predicted is None) == (other.candidate.predicted is None)
    assert again.posterior is not None and found.posterior is not None
    np.testing.assert_array_equal(again.posterior.sd, found.posterior.sd)
    np.testing.assert_array_equal(again.posterior.offset, found.posterior.offset)
    for mine, known in zip(again.problem.space.variables, found.problem.space.variables, strict=True):
        assert replace(mine, parameter=known.parameter) == known
    assert again.problem.space.ties == found.problem.space.ties


def test_standard_deviations_of_another_design_are_left_out(tmp_path: Path) -> None:
    best = recall(kept(odd(), tmp_path, *ODD_WEIGHTS), reduced(), tmp_path).correlation.run.best
    write_run(chosen(odd(), best - 1), tmp_path)
    again = recall(read_study_of(tmp_path, *ODD_WEIGHTS), reduced(), tmp_path).correlation
    assert again.run.best == best and again.posterior is None


def test_other_weights_need_no_evaluation(tmp_path: Path) -> None:
    study = kept(odd(), tmp_path, CharacteristicOptions(match="*", linear=3.0, constraint=False))
    again = recall(study, reduced(), tmp_path).correlation
    plain = pd.DataFrame(term_columns(odd()))
    objectives = plain[(plain["kind"] == "objective") & (plain["goal"] == "target")]
    now = pd.DataFrame(term_columns(again))
    assert again.feasible and set(objectives["id"]) <= set(now[now["kind"] == "objective"]["id"])
    assert again.rating == pytest.approx(now["final_term"].sum())
    assert len(evaluation_table(again).rows) == 10 and characteristic_table(again).rows


def test_the_fit_keeps_the_design_that_it_chose(tmp_path: Path) -> None:
    again = recall(kept(chosen(real(), 0), tmp_path), reduced(), tmp_path).correlation
    assert again.run.best == 0 and max(ratings(again)) > again.rating


def test_what_a_discovery_objects_to_is_said_again(tmp_path: Path) -> None:
    study = kept(real(), tmp_path)
    document = run_document(real(), objections=[Objection("hub is the leading one of a class.")], misfit=1.7)
    write_json(tmp_path / "run.json", document)
    assessment = recall(study, reduced(), tmp_path).assessment
    assert assessment.status == "doubtful"
    assert "hub is the leading one of a class." in assessment.reasons
    assert any("1.7 times the noise" in r for r in assessment.reasons)


@pytest.mark.parametrize("same", [True, False])
def test_the_answer_of_a_run_is_read_back(same: bool, tmp_path: Path) -> None:
    """Its gap is that of the axle handed over then: of another design it is not known."""
    study = kept(odd(), tmp_path, *ODD_WEIGHTS)
    best = recall(study, reduced(), tmp_path).correlation.run.best
    gap = GapRecord(nominal=9.0, tuned=3.0, final=1.1, noise_floor=0.99)
    answer = AnswerRecord(verdict="named", effects=[{"id": "hub"}], added=["Hub: 3 Nm"], gap=gap, seconds=7.5)
    found = chosen(odd(), best if same else best - 1)
    write_json(tmp_path / "run.json", run_document(found, answer=answer))
    again = recall(study, reduced(), tmp_path).answer
    assert again == (answer if same else answer.model_copy(update={"gap": None}))


def test_a_correlation_alone_has_no_answer(tmp_path: Path) -> None:
    assert recall(kept(real(), tmp_path), reduced(), tmp_path).answer is None


def test_what_a_chain_began_with_is_read_back(tmp_path: Path) -> None:
    study = kept(real(), tmp_path)
    document = run_document(real(), discovered=True, without={("lateral", "camber"), ("steer", "toe")})
    write_json(tmp_path / "run.json", document)
    again = recall(study, reduced(), tmp_path).correlation
    out = {t.entry.id for t in again.problem.targets.characteristics if t.excluded}
    assert out == {"lateral.camber_change", "steer.steering_ratio"}
    assert {("lateral", "camber"), ("steer", "toe")} <= again.problem.targets.dropped


def test_a_store_without_the_designs(tmp_path: Path) -> None:
    study = kept(odd(), tmp_path / "one", *ODD_WEIGHTS)
    empty = replace(study, out=tmp_path / "other")
    with pytest.raises(InputError, match=r"evaluation 0 is not in .*run doe-kc correlate again"):
        recall(empty, reduced(), tmp_path / "one")
