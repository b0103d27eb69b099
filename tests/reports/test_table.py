"""A quantity declared once reaches every report."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace

import pytest
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.reports.render.csv import table_frame
from doe_kc.reports.render.json import table_records
from doe_kc.reports.render.page import table_html
from doe_kc.reports.render.terminal import table_lines
from doe_kc.reports.render.workbook import TABLE_FIRST_ROW, put_table, table_sheet
from doe_kc.reports.table import (
    Bar,
    Column,
    Inside,
    PageCell,
    PageLayout,
    Scale,
    SheetLayout,
    Table,
    TerminalCell,
    four_digits,
    row_digits,
    zero_format,
)


@dataclass(frozen=True)
class Spring:
    """A row of the test."""

    name: str
    rate: float
    preload: float
    used: bool | None


SPRINGS = (Spring("front <b>", 25.125, 300.0, True), Spring("=rear", math.nan, -10.0, None))
COLUMNS: tuple[Column[Spring], ...] = (
    Column("name", "Spring", lambda r: r.name, page=PageCell(style="first wide")),
    Column("rate", "Rate, N/mm", lambda r: r.rate, "0.00", 9, page=PageCell(digits=3), json="rate"),
    Column("used", "Used", lambda r: r.used, json="used"),
)
PRELOAD: Column[Spring] = Column(
    "preload", "Preload, N", lambda r: r.preload, "0", 12.5, page=PageCell(layout="+.1f"), json="preload",
    terminal=TerminalCell("preload", ">9", ".1f"),
)  # fmt: skip
TABLE = Table("Springs", "Of one axle.", COLUMNS, SPRINGS, page=PageLayout("springs", "Springs"))


def sheet(table: Table[Spring]) -> Worksheet:
    return table_sheet(Workbook(), table, "Study")


def heads(ws: Worksheet) -> list[object]:
    return [c.value for c in ws[TABLE_FIRST_ROW - 1]]


def test_one_column_more_stands_in_csv_sheet_page_terminal_and_json() -> None:
    more = replace(TABLE, columns=(*COLUMNS, PRELOAD))
    assert list(table_frame(TABLE).columns) == ["name", "rate", "used"]
    assert list(table_frame(more)["preload"]) == [300.0, -10.0]
    ws = sheet(more)
    assert heads(ws) == [*heads(sheet(TABLE)), "Preload, N"]
    assert [ws[f"D{r}"].value for r in (5, 6)] == [300.0, -10.0]
    assert (ws["D5"].number_format, ws.column_dimensions["D"].width) == ("0", 12.5)
    assert ws.auto_filter.ref == "A4:D6"
    new = '<td class="n" data-value="-10.0">−10.0</td>'
    assert new in table_html(more) and new not in table_html(TABLE)
    assert table_lines(more) == ["  preload", "    300.0", "    -10.0"] and table_lines(TABLE) == ["", "", ""]
    assert [r["preload"] for r in table_records(more)] == [300.0, -10.0]


def test_what_is_unknown_stays_empty_and_truth_is_said_in_words() -> None:
    frame = table_frame(TABLE)
    assert list(frame["used"]) == [True, ""] and math.isnan(frame["rate"][1])
    ws = sheet(TABLE)
    assert [ws[f"C{r}"].value for r in (5, 6)] == ["yes", None]
    assert ws["B6"].value is None and ws["B5"].value == 25.125
    assert table_records(TABLE)[0] == {"rate": 25.125, "used": True}
    assert "–</td>" in table_html(TABLE)


def test_page_escapes_text_and_rounds_numbers() -> None:
    html = table_html(TABLE)
    assert '<td class="first wide">front &lt;b&gt;</td>' in html
    assert re.search(r'<th scope="col" class="n" data-type="number">Rate, N/mm</th>', html)
    assert '<th scope="col" class="first">Spring</th>' in html and ">25.1</td>" in html
    strong = replace(COLUMNS[0], page=PageCell[Spring](strong=lambda r: r.rate > 0))
    assert "<td><b>front &lt;b&gt;</b></td>" in table_html(replace(TABLE, columns=(strong,)))


def test_orders_of_sheet_and_page_name_only_what_comes_first() -> None:
    layout = PageLayout[Spring]("springs", "Springs", first=("preload",))
    table = replace(
        TABLE, columns=(*COLUMNS, PRELOAD), sheet=SheetLayout(first=("used", "rate")), page=layout
    )
    assert heads(sheet(table)) == ["Used", "Rate, N/mm", "Spring", "Preload, N"]
    assert [c.key for c in table.page_columns] == ["preload", "name", "rate"]
    assert list(table_frame(table).columns) == ["name", "rate", "used", "preload"]


def test_colors_frozen_column_and_print_follow_the_keys() -> None:
    table = replace(
        TABLE,
        columns=(*COLUMNS, PRELOAD),
        colors=(
            Inside("rate", "used", "preload"),
            Bar("preload", "123456", 100),
            Scale("rate", "preload", ((-1, "000000"), (0, "FFFFFF"), (1, "FF0000"))),
        ),
        flagged=lambda r: r.preload < 0,
        sheet=SheetLayout(frozen="rate", printed_to="used"),
    )
    ws = sheet(table)
    ranges = {str(r.sqref): [(k.type, k.formula) for k in r.rules] for r in ws.conditional_formatting}
    inside = "AND($B5>=$C5,$B5<=$D5)"
    assert ranges["B5:B6"] == [("expression", [inside]), ("expression", [f"NOT({inside})"])]
    assert ranges["D5:D6"][0][0] == "dataBar" and ranges["B5:D6"][0][0] == "colorScale"
    assert (ws.freeze_panes, ws.print_title_rows) == ("B5", "$1:$4")
    assert str(ws.print_area).endswith("$A$1:$C$6")
    assert [bool(ws[f"A{r}"].fill.fill_type) for r in (5, 6)] == [False, True]


def test_heads_are_on_every_printed_page() -> None:
    assert sheet(TABLE).print_title_rows == "$1:$4"


def test_a_sheet_without_rows_says_why() -> None:
    ws = sheet(replace(TABLE, rows=(), empty="No spring."))
    assert ws["A5"].value == "No spring."
    assert list(table_frame(replace(TABLE, rows=())).columns) == ["name", "rate", "used"]


def test_text_stays_text_and_a_second_table_has_no_filter() -> None:
    ws = sheet(TABLE)
    assert ws["A6"].data_type == "s" and ws["A6"].value == "=rear"
    assert put_table(ws, TABLE, start=10) == 12
    assert ws.auto_filter.ref == "A4:C6"


def test_two_columns_of_one_key_are_refused() -> None:
    with pytest.raises(ValueError, match="table Springs: more than one column is called rate"):
        replace(TABLE, columns=(*COLUMNS, COLUMNS[1]))


def test_zero_has_neither_sign_nor_decimals() -> None:
    shown = [zero_format(v, "0.00") for v in (-0.004, 0.004, -0.006, 0.0, -0.0)]
    assert shown == ['"0.00"', "0.00", "0.00", "0", "0"]
    assert zero_format(-0.1, "0") == '"0"' and zero_format(-0.1, "0.0%") == "0.0%"
    assert zero_format("text", "0.0") == "0.0"


def test_digits_follow_the_standard_deviation_or_the_size() -> None:
    assert [row_digits(sd, 123.0) for sd in (0.012, 0.5, math.nan)] == ["0.000", "0.00", "0"]
    assert [four_digits(v) for v in (-8507.02, -0.4051, 0.0, math.nan)] == ["0", "0.0000", "0", "0"]


def test_a_cell_of_the_sheet_alone() -> None:
    name = replace(COLUMNS[0], cell=lambda r: f"{r.name} (id)")
    table = replace(TABLE, columns=(name, *COLUMNS[1:]))
    assert sheet(table)["A5"].value == f"{TABLE.rows[0].name} (id)"
    assert list(table_frame(table)["name"]) == [r.name for r in TABLE.rows]
