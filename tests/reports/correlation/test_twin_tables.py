"""Where an outside model and its twin disagree, in table, page, workbook, terminal and JSON."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from openpyxl import load_workbook

from doe_kc.correlation.problem import Candidate
from doe_kc.correlation.result import Correlation
from doe_kc.correlation.twin import Twin
from doe_kc.correlation.twin_agreement import TwinAgreement, TwinDifference, twin_agreement
from doe_kc.effects import apply_effect
from doe_kc.reports.correlation.summary import summary
from doe_kc.reports.correlation.twin_tables import twin_entry, twin_table
from doe_kc.reports.correlation.workbook import write_correlation_workbook
from doe_kc.reports.page.correlation import twin_section, write_correlation_page
from doe_kc.reports.render.csv import table_columns
from doe_kc.workflow.write_correlation import correlation_document
from tests.reports.correlations import real


def disagreeing() -> Correlation:
    """The real correlation beside a twin with a compliant hub."""
    known = real()
    stiff = apply_effect(known.problem.axle, "hub_compliance", {}, source="test")
    problem = replace(known.problem, exact=False, twin=Twin(stiff))
    evaluated = known.run.evaluated
    agreement = twin_agreement(problem, evaluated, evaluated[known.run.best])
    return replace(known, problem=problem, twin=agreement)


def test_the_places_of_an_effect_that_one_model_has_come_first() -> None:
    agreement = disagreeing().twin
    assert agreement is not None and agreement.status == "doubtful"
    assert agreement.share is not None and agreement.share > 0.99
    assert {(r.load_case, r.response) for r in agreement.rows[:3]} <= {
        (case, "camber") for case in ("lateral", "lateral_opposite", "lateral_offset")
    }
    worst = agreement.rows[0]
    sizes = [r.size for r in agreement.rows]
    assert sizes == sorted(sizes, reverse=True) and worst.size > 5.0
    assert "ateral" in agreement.line and "(camber)" in agreement.line and "import error" in agreement.line


def test_noise_units_are_those_of_the_records() -> None:
    known = disagreeing()
    assert known.twin is not None and known.problem.twin is not None
    row = next(r for r in known.twin.rows if (r.load_case, r.response) == ("lateral", "camber"))
    best = known.best
    twin = known.problem.twin.answer(known.problem.space, best.point)
    data, squares = known.problem.likelihood, []
    apart = data.residual(best.outcome.curves, best.outcome.characteristics) - data.residual(
        twin.curves, twin.characteristics
    )
    for curve, place in data.slices():
        if (curve.load_case, curve.response) == ("lateral", "camber"):
            squares.append(apart[place] ** 2)
    assert row.best == np.sqrt(np.mean(squares))
    assert best.outcome.curves is not None and twin.curves is not None
    ours, other = (c.cases["lateral"] for c in (best.outcome.curves, twin.curves))
    mean = ours.mean["camber"] - other.mean["camber"]
    assert abs(row.largest) == np.abs(mean).max()
    assert row.at in ours.input and row.loop == 0.0


def test_a_friction_that_one_model_has_shows_in_the_loops() -> None:
    known = real()
    rubbing = apply_effect(known.problem.axle, "steering_friction", {}, source="test")
    problem = replace(known.problem, exact=False, twin=Twin(rubbing))
    agreement = twin_agreement(problem, known.run.evaluated, known.best)
    assert agreement is not None and agreement.status == "doubtful"
    toe = next(r for r in agreement.rows if (r.load_case, r.response) == ("lateral", "toe"))
    assert toe.loop < 0.0 or toe.loop > 0.0
    assert toe.loop_noise > 1.0 and toe in agreement.beyond


def test_it_stands_everywhere(tmp_path: Path) -> None:
    known = disagreeing()
    assert known.twin is not None
    assert summary(known)["Twin"].startswith("Doubtful: The outside model and its twin differ")
    entry = correlation_document(known, tmp_path / "axle.toml")["twin"]
    assert entry == twin_entry(known.twin)
    assert entry["status"] == "doubtful" and entry["differences"][0]["noise_best"] > 5.0
    columns = table_columns(twin_table(known.twin))
    assert columns["load_case"][0].startswith("lateral") and len(columns["at"]) == len(known.twin.rows)
    book = write_correlation_workbook(tmp_path / "book.xlsx", known, study="s", date="d")
    assert "Twin" in load_workbook(book).sheetnames
    (section,) = twin_section(known)
    page = write_correlation_page(tmp_path / "page.html", known, None, study="s", date="d")
    assert section.title == "Twin" and "Outside model and twin" in page.read_text(encoding="utf-8")


def test_without_a_twin_there_is_nothing_of_it(tmp_path: Path) -> None:
    known = real()
    assert "Twin" not in summary(known) and twin_section(known) == []
    assert "twin" not in correlation_document(known, tmp_path / "axle.toml")


def test_without_records_the_differences_have_no_size() -> None:
    row = TwinDifference("lateral", "toe", np.nan, np.nan, 0.1, 500.0, 0.0)
    agreement = TwinAgreement((row,), None, None)
    assert row.size == 0.0 and agreement.status == "sound" and "Without measured curves" in agreement.line
    apart = replace(agreement, alike=False)
    assert apart.status == "doubtful" and "differ by more than a fifth" in apart.line
    known = real()
    one = known.problem.judged(0, Candidate(known.best.point, "x"), known.best.outcome)
    assert twin_agreement(known.problem, [one], one) is None
