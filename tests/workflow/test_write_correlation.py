"""What a correlation hands over: an axle that rates the same, complete files, the JSON's shape."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from openpyxl import load_workbook

from doe_kc.axle_file import read_axle
from doe_kc.ground.output import write_json
from doe_kc.study import Study, read_study
from doe_kc.workflow.write_correlation import correlation_document, correlation_lines, write_correlation
from tests.correlation.cases import measured, outcome
from tests.reference import EXAMPLE
from tests.reports.correlations import CAR, all_three, odd, real

KEYS = {
    "name", "unit", "target", "sd", "baseline", "final", "improvement_percent", "low", "high", "role", "held",
    "reachable",
}  # fmt: skip
FILES = {
    "axle.toml", "parameters.csv", "characteristics.csv", "curves.csv", "rating_terms.csv", "evaluations.csv",
    "correlation.xlsx", "report.html",
}  # fmt: skip


def study() -> Study:
    return read_study(EXAMPLE)


@pytest.fixture(scope="module")
def handed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("out")
    paths = write_correlation(study(), real(), measured(CAR), folder)
    assert len(paths) == len(set(paths)) and all(p.stat().st_size for p in paths)
    return folder


def test_every_file_is_there(handed: Path) -> None:
    names = {p.name for p in handed.iterdir()}
    assert names >= {*FILES, "hysteresis.csv", "hysteresis.png"} and not any(n.startswith(".") for n in names)
    assert load_workbook(handed / "correlation.xlsx")["Axle"]._images
    assert [sum(n.endswith(end) for n in names) for end in (".png", ".svg")] == [13, 0]


def test_the_axle_handed_over_rates_the_same(handed: Path) -> None:
    axle = read_axle(handed / "axle.toml")
    assert dict(axle.values) == dict(real().axle.values)
    best = real().best
    again = real().problem.judged(0, best.candidate, outcome(axle, {}))
    assert again.merit == pytest.approx(real().rating, rel=1e-9)


@pytest.mark.parametrize("name", ["odd", "typed"])
def test_works_with_failures_and_without_records_posterior_or_curves(name: str, tmp_path: Path) -> None:
    found = all_three()[name]
    short = replace(found, posterior=None)
    bare = [replace(e, outcome=replace(e.outcome, curves=None)) for e in short.run.evaluated]
    short = replace(short, run=replace(short.run, evaluated=tuple(bare)))
    paths = write_correlation(study(), short, None, tmp_path / "out", workers=1)
    assert {p.name for p in paths} >= FILES
    assert dict(read_axle(tmp_path / "out" / "axle.toml").values) == dict(found.axle.values)
    table = pd.read_csv(tmp_path / "out" / "evaluations.csv")
    assert len(table) == len(found.run.evaluated)


@pytest.mark.parametrize("name", ["real", "odd", "typed"])
def test_the_document_has_the_agreed_shape(name: str, tmp_path: Path) -> None:
    found = all_three()[name]
    path = write_json(tmp_path / "c.json", correlation_document(found, tmp_path / "axle.toml"))
    document = json.loads(path.read_text(encoding="utf-8"))
    assert set(document) == {
        "method", "evaluations", "rating", "feasible", "mean_improvement_percent", "characteristics",
        "parameters", "axle", "seconds", "stopped", "steps", "notes", "status", "reasons",
    }  # fmt: skip
    assert all(set(c) == KEYS for c in document["characteristics"])
    assert all(c["low"] < c["high"] for c in document["characteristics"])
    assert set(document["parameters"]) == set(found.values)
    assert all(set(p) == {"baseline", "final", "sd", "inward"} for p in document["parameters"].values())
    assert document["rating"] == found.rating and document["evaluations"] == len(found.run.evaluated)


def test_the_terminal_says_what_is_outside_and_at_a_bound() -> None:
    text = "\n".join(correlation_lines(odd()))
    (line,) = [x for x in text.splitlines() if x.startswith("vertical.bump_steer")]
    assert "*" in line
    assert "Rating: -" in text and "end at a bound" in text
    assert len(correlation_lines(real())) < 45
