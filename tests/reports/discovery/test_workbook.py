"""The discovery workbook, read back."""

from __future__ import annotations

from pathlib import Path

import pytest
from openpyxl import load_workbook
from openpyxl.chart import LineChart
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.ground.errors import RunError
from doe_kc.reports.discovery.words import STATUS_WORDS
from doe_kc.reports.discovery.workbook import verdict_lines, write_discovery_workbook
from doe_kc.reports.render.charts import DATA_COLUMN
from tests.discovery.cases import discovery
from tests.reports.correlations import EVIL

SHEETS = [
    "Verdict", "Disagreement", "Effects", "Library", "Groups", "Gap chart", "Gap", "Held out", "Parameters",
    "Legend",
]  # fmt: skip
CARS = ["none", "named", "class", "unexplained", "lead", "two"]


def written(tmp_path: Path, car: str, study: str = "Study") -> Workbook:
    path = tmp_path / f"{car}.xlsx"
    return load_workbook(
        write_discovery_workbook(path, discovery(car), study=study, date="2026-01-31", notes={"Axle": EVIL})
    )


def column(ws: Worksheet, head: str) -> list[object]:
    at = [c.value for c in ws[4]].index(head) + 1
    return [ws.cell(r, at).value for r in range(5, ws.max_row + 1)]


@pytest.mark.parametrize("car", CARS)
def test_sheets_and_rows(car: str, tmp_path: Path) -> None:
    book, found = written(tmp_path, car), discovery(car)
    assert book.sheetnames == SHEETS
    assert len(column(book["Disagreement"], "z re-tuned")) == len(found.nominal_map.names)
    status = column(book["Library"], "Status")
    assert len(status) == len(found.statuses)
    assert set(status) <= set(STATUS_WORDS.values())
    assert len(column(book["Gap"], "Re-tuned")) == 1 + len(found.gaps)
    paths = [str(v).partition(":")[0] for v in column(book["Parameters"], "Parameter")]
    assert paths == list(found.fitted.model.space.paths)
    text = [row[1].value for row in book["Verdict"].iter_rows(min_row=4)]
    assert found.sentences[0] in str(text[0])


def test_what_is_beyond_noise_comes_first_and_is_printed_the_worst_on_top(tmp_path: Path) -> None:
    ws = written(tmp_path, "named")["Disagreement"]
    sizes = [abs(float(v)) for v in column(ws, "z re-tuned") if isinstance(v, int | float)]
    marked = [bool(v) for v in column(ws, "Beyond noise")]
    beyond = sum(marked)
    assert 0 < beyond < len(sizes) and all(marked[:beyond])
    for part in (sizes[:beyond], sizes[beyond:]):
        assert part == sorted(part, reverse=True)
    assert str(ws.print_area).endswith(f"$H${4 + beyond}")
    assert "re-tuned" in str(column(ws, "Beyond noise")[0])


def test_the_gap_chart_has_a_series_a_model_and_a_category_a_row(tmp_path: Path) -> None:
    for car, models in (("named", 4), ("none", 2)):
        ws, gaps = written(tmp_path, car)["Gap chart"], discovery(car).gaps
        (chart,) = ws._charts
        assert isinstance(chart, LineChart) and len(chart.series) == models
        assert chart.y_axis.scaling.logBase == 2
        heads = [ws.cell(5, c).value for c in range(DATA_COLUMN, DATA_COLUMN + 2 + models)]
        assert heads[:4] == ["Load case", "Response", "As handed in", "Re-tuned"]
        tuned = [ws.cell(r, DATA_COLUMN + 3).value for r in range(7, 7 + len(gaps))]
        assert tuned == pytest.approx([g.gap.tuned for g in gaps])
        assert chart.series[1].val.numRef.f.endswith(f"${6 + len(gaps)}")


def test_text_never_becomes_a_formula(tmp_path: Path) -> None:
    book = written(tmp_path, "named", study="=1+1" + EVIL)
    assert not [c for ws in book for row in ws.iter_rows() for c in row if c.data_type == "f"]


def test_sheets_without_rows_say_so(tmp_path: Path) -> None:
    book = written(tmp_path, "none")
    assert "No effect" in str(book["Effects"].cell(5, 1).value)
    assert "No effect" in str(book["Held out"].cell(5, 1).value)


def test_the_verdict_tells_what_is_open_and_what_to_test() -> None:
    heads = [head for head, _ in verdict_lines(discovery("class"))]
    assert "Cannot be told apart" in heads and "Test next" in heads
    lines = dict(verdict_lines(discovery("unexplained")))
    assert "times the noise" in lines["Unexplained at"] and "Without the library" in lines
    assert "Lead" in dict(verdict_lines(discovery("lead")))
    named = verdict_lines(discovery("named"))
    assert "Effect" in dict(named) and "Step by step" in dict(named)


def test_the_first_lines_of_the_verdict_are_without_statistics() -> None:
    heads = [head for head, _ in verdict_lines(discovery("named"))]
    until = [text for _, text in verdict_lines(discovery("named"))[: heads.index("Statistics")]]
    assert until and not any(w in text for text in until for w in ("log10", "odds", "Whitened", "_Nm"))


def test_unwritable_place_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    with pytest.raises(RunError, match="out"):
        write_discovery_workbook(tmp_path / "out" / "x.xlsx", discovery("none"), study="S", date="d")
