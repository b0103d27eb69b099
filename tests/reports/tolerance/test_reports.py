"""Tables, workbook, page and pictures of a tolerance study say what its arrays say."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from openpyxl import load_workbook

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.production_scatter.requirements import Requirement
from doe_kc.production_scatter.result import MeasuredCar, Tolerance
from doe_kc.production_scatter.study import tolerance_study
from doe_kc.reports.page.tolerance import tolerance_sections
from doe_kc.reports.render.csv import table_columns
from doe_kc.reports.tolerance.bands import band_sheet
from doe_kc.reports.tolerance.contributions import contribution_matrix, contribution_table, reduction_matrix
from doe_kc.reports.tolerance.figures import contributions, distributions, measured_handles, tightening_bars
from doe_kc.reports.tolerance.scatter import band_table
from doe_kc.reports.tolerance.tables import tightening_table, tolerance_table
from doe_kc.reports.tolerance.words import conclusions, ranked_tightenings
from doe_kc.reports.tolerance.workbook import write_tolerance_workbook
from doe_kc.true_solver.own import AxleSolver
from tests.production_scatter.cases import FEW, example, scatter_of

BUMP, CAMBER = "vertical.bump_steer", "static.camber"


@pytest.fixture(scope="module")
def done() -> Tolerance:
    nominal = AxleSolver(example()).evaluate({})
    assert nominal.curves is not None
    values = dict(zip(CHARACTERISTICS, nominal.characteristics, strict=True))
    cars = [MeasuredCar("car <1>", values, nominal.curves), MeasuredCar("far", {BUMP: 99.0}, nominal.curves)]
    requirements = {
        BUMP: Requirement(CHARACTERISTICS[BUMP], -5.0, -3.0),
        CAMBER: Requirement(CHARACTERISTICS[CAMBER], -np.inf, 0.0),
    }
    return tolerance_study(
        example(), AxleSolver(example()), scatter_of(parameters=FEW), n=40, seed=1,
        requirements=requirements, cars=cars, workers=1,
    )  # fmt: skip


def test_the_table_of_characteristics(done: Tolerance) -> None:
    columns = table_columns(tolerance_table(done))
    row = columns["name"].index(BUMP)
    values = done.values[:, row]
    assert columns["sd"][row] == pytest.approx(values.std(ddof=1))
    assert columns["p50"][row] == pytest.approx(np.percentile(values, 50.0))
    assert columns["outside"][row] == ((values < -5.0) | (values > -3.0)).mean()
    assert (columns["low"][row], columns["high"][row]) == (-5.0, -3.0)
    assert columns["measured_far"][row] == 99.0 and columns["measured_far_percent"][row] == 100.0
    other = columns["name"].index("vertical.ride_rate")
    assert np.isnan(columns["outside"][other]) and np.isnan(columns["measured_far"][other])


def test_contributions_and_reductions(done: Tolerance) -> None:
    columns = table_columns(contribution_table(done))
    of = {
        (p, c): (f, left, right)
        for p, c, f, left, right in zip(
            columns["parameter"], columns["name"], columns["first_order"], columns["first_order_left"],
            columns["first_order_right"], strict=True,
        )
    }  # fmt: skip
    assert sum(of[p, BUMP][0] for p in FEW) == pytest.approx(1.0)
    assert of["ROB.z", BUMP][0] == pytest.approx(sum(of["ROB.z", BUMP][1:]))
    assert of["ROB.z", BUMP][1] > of["ROB.z", BUMP][2]  # the left wheel's characteristic
    assert np.isnan(of["arb.radius", BUMP][1])
    for table in (
        contribution_matrix(done, "first"),
        contribution_matrix(done, "total"),
        reduction_matrix(done),
    ):
        assert len(table.rows) == len(FEW) and len(table.columns) == 2 + len(done.characteristics)


def test_what_to_tighten_is_ranked(done: Tolerance) -> None:
    columns = table_columns(tightening_table(done))
    assert columns["gain"] == sorted(columns["gain"], reverse=True)
    assert columns["path"][0] == ranked_tightenings(done)[0].scatter.parameter.path
    assert columns["path"][0] in ("ROB.z", "LLF.z") and columns["gain"][0] > 0.0
    words = " ".join(conclusions(done))
    assert f"Halving the scatter of {columns['path'][0]}" in words and "of the cars are outside" in words
    unranked = table_columns(tightening_table(done, ranked=False))
    assert unranked["path"] == [s.parameter.path for s in done.model.scatters]


def test_sentences_without_requirements(done: Tolerance) -> None:
    from dataclasses import replace

    words = conclusions(replace(done, requirements={}))
    assert not any("outside" in w for w in words) and any("off the standard deviation of" in w for w in words)
    columns = table_columns(tightening_table(replace(done, requirements={})))
    assert np.isnan(columns["gain"]).all()


def test_a_nominal_that_is_outside_is_named(done: Tolerance) -> None:
    from dataclasses import replace

    off = {BUMP: Requirement(CHARACTERISTICS[BUMP], 50.0, 60.0)}
    words = conclusions(replace(done, requirements=off))
    assert any("The unchanged axle is itself outside in vertical.bump_steer" in w for w in words)
    assert any(w.startswith("100 % (91 to 100) of the cars") for w in words)


def test_the_bands_say_how_much_of_a_car_is_inside(done: Tolerance) -> None:
    columns = table_columns(band_table(done))
    assert set(columns["side"]) == {"L", "R"} and min(columns["inside_car <1>"]) > 0.9
    assert max(columns["width"]) > 0.0


def test_the_workbook(done: Tolerance, tmp_path: Path) -> None:
    book = load_workbook(write_tolerance_workbook(tmp_path / "t.xlsx", done, study="s", date="d"))
    assert book.sheetnames == [
        "Summary", "Characteristics", "Tightening", "First order", "Total", "Reduction", "Bands", "Scatter",
        "Legend",
    ]  # fmt: skip
    ws = book["Characteristics"]
    heads = [c.value for c in ws[4]]
    column = heads.index("Standard deviation")
    sd = {row[0].value: row[column].value for row in ws.iter_rows(min_row=5)}
    for scatter in done.scatters:
        assert sd[scatter.entry.id] == pytest.approx(scatter.moments.sd)
    totals = [c.value for c in book["Total"][book["Total"].max_row]]
    assert totals[0] == "Not attributed, at most, %" and isinstance(totals[2], float)


def test_the_page(done: Tolerance) -> None:
    sections = tolerance_sections(done, study="s")
    assert [s.title for s in sections] == [
        "What follows", "Characteristics", "What to tighten", "Contributions", "Curves",
        "Scatter of the parameters", "Words",
    ]  # fmt: skip
    html = "".join(s.html for s in sections)
    assert "car &lt;1&gt;" in html and "car <1>" not in html
    assert html.count("data:image/png") == 3 + len(done.bands)


def test_the_pictures_hold_all_their_words(done: Tolerance) -> None:
    looks = measured_handles(done)
    assert len(looks) == 2 and looks[0].get_label() == "measured: car <1>"
    pages = [distributions(done, study="s"), contributions(done, study="s"), tightening_bars(done, study="s")]
    pages.append(band_sheet(done.bands[0], done.cars, looks, study="s"))
    for page in pages:
        assert not page.outside and page.pixels().min() == 0
    assert any("99 →" in w.text for w in pages[0].words)
    assert len(pages[0].panels) == len(done.characteristics)


def test_the_table_as_csv_reads_back(done: Tolerance, tmp_path: Path) -> None:
    from doe_kc.ground.output import write_columns

    path = write_columns(tmp_path / "c.csv", table_columns(tolerance_table(done)))
    with path.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [r["name"] for r in rows] == [c.id for c in done.characteristics]
    assert json.loads(rows[0]["sd"]) == pytest.approx(done.scatters[0].moments.sd, rel=1e-8)
