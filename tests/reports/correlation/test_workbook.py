"""The correlation workbook, read back and recalculated."""

from __future__ import annotations

import shutil
import subprocess
import warnings
from base64 import b64decode
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from openpyxl import load_workbook
from openpyxl.chart import BarChart
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.reports.correlation.rating_sheet import FINAL_RATING, HEADS, RATING_FIRST_ROW
from doe_kc.reports.correlation.workbook import write_correlation_workbook
from doe_kc.reports.hysteresis import loop_widths
from doe_kc.targets import Targets
from tests.correlation.cases import measured
from tests.reports.correlations import CAR, EVIL, all_three, odd, real

SHEETS = [
    "Summary", "DNA", "Axle", "Characteristics", "Parameters", "Curves", "Hysteresis", "Evaluations",
    "Rating terms", "Legend",
]  # fmt: skip
PIXEL = b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)
OFFICE = shutil.which("soffice")


def written(tmp_path: Path, name: str = "odd", study: str = "Study") -> Workbook:
    path, found = tmp_path / f"{name}.xlsx", all_three()[name]
    seen: dict[str, Any] = {}
    if name == "real":
        seen = {"loops": loop_widths(found, measured(CAR)), "axle_picture": PIXEL}
    write_correlation_workbook(path, found, study=study, date="2026-01-31", notes={"Axle": EVIL}, **seen)
    return load_workbook(path)


def column(ws: Worksheet, head: str, row: int) -> list[object]:
    at = [c.value for c in ws[row]].index(head) + 1
    return [ws.cell(r, at).value for r in range(row + 1, ws.max_row + 1)]


@pytest.mark.parametrize("name", ["real", "odd", "typed"])
def test_sheets_and_rows(name: str, tmp_path: Path) -> None:
    book, found = written(tmp_path, name), all_three()[name]
    drawn = SHEETS if name == "real" else [s for s in SHEETS if s not in ("Axle", "Hysteresis")]
    assert book.sheetnames == drawn
    values = column(book["Characteristics"], "Final", 4)
    assert sorted(map(float, values)) == pytest.approx(sorted(e.final for e in found.improvements))  # type: ignore[arg-type]
    paths = [str(v).partition(":")[0] for v in column(book["Parameters"], "Parameter", 4)]
    assert paths == list(found.values)
    assert len(column(book["Evaluations"], "Origin", 4)) == len(found.run.evaluated)


def test_text_never_becomes_a_formula(tmp_path: Path) -> None:
    book = written(tmp_path, study="=1+1" + EVIL)
    formulas = {
        (ws.title, c.coordinate) for ws in book for row in ws.iter_rows() for c in row if c.data_type == "f"
    }
    assert {sheet for sheet, _ in formulas} == {"Summary", "Rating terms"}
    assert len([1 for sheet, _ in formulas if sheet == "Summary"]) == 1


def test_bounds_and_the_design_handed_over_are_shaded(tmp_path: Path) -> None:
    book = written(tmp_path)
    ws = book["Parameters"]
    shaded = [ws.cell(r, 2).value for r in range(5, ws.max_row + 1) if ws.cell(r, 2).fill.fill_type]
    assert [str(v).partition(":")[0] for v in shaded] == ["llf.Fy", "llr.Fy"]
    ws = book["Evaluations"]
    assert [r - 4 for r in range(5, ws.max_row + 1) if ws.cell(r, 1).fill.fill_type] == [odd().run.best + 1]


def test_the_dna_chart_shows_the_characteristics_about_their_targets(tmp_path: Path) -> None:
    book = written(tmp_path, "real")
    (chart,) = book["DNA"]._charts
    last = 4 + len(real().improvements)
    assert isinstance(chart, BarChart) and chart.x_axis.crossesAt == 1.0
    data, heads = book["Characteristics"], []
    for series in chart.series:
        letter = series.val.numRef.f.split("$")[1]
        assert series.val.numRef.f == f"'Characteristics'!${letter}$5:${letter}${last}"
        heads.append(data[f"{letter}4"].value)
    assert heads == ["Baseline, normalised", "Final, normalised"]
    assert len(book["Axle"]._images) == 1


def test_every_sheet_prints_on_a4_with_its_title(tmp_path: Path) -> None:
    for ws in written(tmp_path, "real"):
        setup, sense = ws.page_setup, "portrait" if ws.title == "Axle" else "landscape"
        assert (setup.orientation, int(setup.paperSize)) == (sense, 9)
        assert ws.sheet_properties.pageSetUpPr.fitToPage
        if ws.auto_filter.ref:
            assert ws.print_title_rows.startswith("$1:")


def test_no_number_is_shown_as_minus_zero(tmp_path: Path) -> None:
    for ws in written(tmp_path, "real"):
        for cell in (c for row in ws.iter_rows() for c in row if isinstance(c.value, float)):
            number = cell.number_format
            if number in ("General", "0") or '"' in number or ";" in number:
                continue
            decimals = len(number.rstrip("%").partition(".")[2])
            value = cell.value * (100.0 if number.endswith("%") else 1.0)
            assert round(value, decimals) or value >= 0.0, (ws.title, cell.coordinate)


def test_inside_and_outside_are_coloured_by_rule(tmp_path: Path) -> None:
    rules = [r for rng in written(tmp_path)["Characteristics"].conditional_formatting for r in rng.rules]
    assert sorted(r.type for r in rules) == ["dataBar", "expression", "expression"]


def heavier(targets: Targets) -> Targets:
    """Other weights, target and interval: what the test types into the yellow cells."""
    first, *rest = targets.characteristics
    assert first.objective is not None
    weights = replace(first.objective, linear=7.5, quadratic=2.0)
    curve, *curves = targets.curves
    other = replace(curve, objective=replace(curve.objective, quadratic=40.0))
    narrowed = [
        replace(t, constraint=replace(t.constraint, low=t.constraint.low + 0.1))
        if t.constraint is not None and t.entry.id == "static.caster"
        else t
        for t in rest
    ]
    changed = (replace(first, value=1.1 * first.value, objective=weights), *narrowed)
    return Targets(changed, (other, *curves), targets.source)


def type_in(ws: Worksheet, targets: Targets) -> None:
    at = {(ws.cell(r, 1).value, ws.cell(r, 3).value): r for r in range(RATING_FIRST_ROW, ws.max_row + 1)}
    first = targets.characteristics[0]
    assert first.objective is not None
    row = at["objective", first.entry.id]
    for head, value in (("Target", first.value), ("LinWt", 7.5), ("QuadWt", 2.0)):
        ws.cell(row, HEADS.index(head) + 1).value = value
    ws.cell(at["curve", targets.curves[0].id], HEADS.index("QuadWt") + 1).value = 40.0
    row = at["constraint", "static.caster"]
    ws.cell(row, HEADS.index("Low") + 1).value += 0.1


@pytest.mark.skipif(OFFICE is None, reason="LibreOffice (soffice) is not installed")
def test_the_rating_recalculates_with_edited_weights(tmp_path: Path) -> None:
    for name in ("real", "odd", "typed"):
        written(tmp_path, name)
    book = load_workbook(tmp_path / "odd.xlsx")
    targets = heavier(odd().problem.targets)
    type_in(book["Rating terms"], targets)
    book.save(tmp_path / "edited.xlsx")
    names = ["real", "odd", "typed", "edited"]
    profile = f"-env:UserInstallation={(tmp_path / 'profile').as_uri()}"
    command = [str(OFFICE), profile, "--headless", "--convert-to", "xlsx:Calc MS Excel 2007 XML"]
    subprocess.run(
        [*command, "--outdir", "out", *(f"{n}.xlsx" for n in names)],
        cwd=tmp_path,
        check=True,
        capture_output=True,
        timeout=180,
    )
    wanted = {n: all_three()[n].rating for n in names[:3]}
    best = odd().best
    wanted["edited"] = replace(odd().problem, targets=targets).judged(0, best.candidate, best.outcome).merit
    assert wanted["edited"] < 1.01 * odd().rating
    for name in names:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # extensions that LibreOffice adds
            book = load_workbook(tmp_path / "out" / f"{name}.xlsx", data_only=True)
        assert book["Rating terms"][FINAL_RATING].value == pytest.approx(wanted[name], rel=1e-12), name
        live = [r[1].value for r in book["Summary"].iter_rows() if r[0].value == "Rating, live"]
        assert live == [pytest.approx(wanted[name], rel=1e-12)], name


def test_the_summary_names_bounds_and_what_was_set_first(tmp_path: Path) -> None:
    text = {r[0].value: r[1].value for r in written(tmp_path, "real")["Summary"].iter_rows(min_row=4)}
    assert text["Beforehand"] == real().steps[0]
    assert "not visible" in str(text["Note 1"])
    assert text["Axle"] == EVIL
