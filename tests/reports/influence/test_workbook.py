"""The influence workbook, read back."""

from __future__ import annotations

import csv
import errno
import io
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from openpyxl import load_workbook
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from doe_kc.characteristics import CHARACTERISTICS, appendix_c
from doe_kc.ground.errors import RunError
from doe_kc.parameter_influence.relations import relations
from doe_kc.parameter_influence.selection import select_variables
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.parameter_influence.study import Influence
from doe_kc.reports.influence.layout import FIRST_MATRIX_ROW, LABELS, layout, step_text
from doe_kc.reports.influence.workbook import InfluenceBook
from doe_kc.reports.render.cells import clean
from tests.parameter_influence.studies import parameter, real_study, study

EVIL = ("=1+1", "+1+1", "-1+1", "@SUM(A1)", '=HYPERLINK("x")', "\t=1+1")
SHEETS = ["Influence", "Absolute", "Exact", "Relations", "Selection", "Legend"]


def write(
    path: Path,
    influence: Influence,
    *,
    name: str = "Study",
    selection: Selection | None = None,
    notes: Mapping[str, str] | None = None,
) -> Workbook:
    InfluenceBook(
        influence, relations(influence), name, "2026-01-31", selection=selection, notes=notes or {}
    ).write(path)
    return load_workbook(path)


def texts(ws: Worksheet) -> list[str]:
    return [c.value for row in ws.iter_rows() for c in row if isinstance(c.value, str)]


@pytest.fixture(scope="module")
def book(tmp_path_factory: pytest.TempPathFactory) -> Workbook:
    real = real_study()
    targets = {c.id: 1.1 * b for c, b in zip(real.characteristics, real.baseline, strict=True)}
    selection = select_variables(real, targets)
    return write(tmp_path_factory.mktemp("book") / "influence.xlsx", real, selection=selection)


def test_sheets_in_order(book: Workbook) -> None:
    assert book.sheetnames == SHEETS


def test_cells_hold_the_matrix_as_numbers(book: Workbook) -> None:
    real, at = real_study(), layout(real_study())
    for sheet, values, tolerance in (
        ("Influence", real.percent, 0.5),
        ("Absolute", real.absolute, 1e-12),
        ("Exact", real.exact, 1e-12),
    ):
        for r, i in enumerate(at.rows, start=FIRST_MATRIX_ROW):
            assert book[sheet].cell(r, 2).value == real.parameters[i].path
            for c, j in enumerate(at.columns, start=LABELS + 1):
                assert book[sheet].cell(r, c).value == pytest.approx(values[i, j], abs=tolerance)


def test_percent_is_a_whole_number_with_its_sign(book: Workbook) -> None:
    cell = book["Influence"].cell(FIRST_MATRIX_ROW, LABELS + 1)
    assert isinstance(cell.value, int)
    assert cell.number_format == '0"%"'


def test_heads_are_those_of_appendix_c(tmp_path: Path) -> None:
    real, wanted = real_study(), appendix_c()
    index = [real.characteristics.index(c) for c in wanted]
    part = replace(
        real, characteristics=tuple(wanted), baseline=real.baseline[index],
        plus=real.plus[:, index], minus=real.minus[:, index], exact=real.exact[:, index],
    )  # fmt: skip
    ws = write(tmp_path / "c.xlsx", part)["Influence"]
    last = LABELS + len(wanted)
    heads = [[ws.cell(r, c).value for c in range(LABELS + 1, last + 1)] for r in (4, 5, 6, 8)]
    assert [v for v in heads[0] if v] == ["KINEMATICS", "COMPLIANCES"]
    assert heads[0].index("COMPLIANCES") == 8
    assert [v for v in heads[1] if v] == [
        "Vertical motion",
        "Roll motion",
        "Steering input",
        "Lateral force",
        "Lateral force, 30 mm offset",
        "Drive force",
        "Brake force",
    ]
    assert heads[2] == [c.label for c in wanted]
    assert heads[3] == [c.unit for c in wanted]


def test_sums_and_ranks(tmp_path: Path) -> None:
    ws = write(tmp_path / "s.xlsx", study([[10.0, 1.0], [-5.0, 4.0], [0.0, 0.0]]))["Influence"]
    assert [ws.cell(r, 6).value for r in range(FIRST_MATRIX_ROW, FIRST_MATRIX_ROW + 3)] == [125, 150, 0]
    assert [ws.cell(r, 7).value for r in range(FIRST_MATRIX_ROW, FIRST_MATRIX_ROW + 3)] == [2, 1, 3]
    assert [ws.cell(FIRST_MATRIX_ROW + 3, c).value for c in (4, 5)] == [150, 125]
    assert [ws.cell(FIRST_MATRIX_ROW + 4, c).value for c in (4, 5)] == [1, 2]


def test_groups_stand_in_every_row_for_the_filter(book: Workbook) -> None:
    ws = book["Influence"]
    groups = [ws.cell(r, 1).value for r in range(FIRST_MATRIX_ROW, FIRST_MATRIX_ROW + 10)]
    assert groups == ["HARDPOINTS"] * 5 + ["BUSHINGS"] * 3 + ["OTHER"] * 2
    assert ws.auto_filter.ref.startswith("A8:") and ws.auto_filter.ref.endswith(str(FIRST_MATRIX_ROW + 9))


def test_view_and_print_setup(book: Workbook) -> None:
    for name in SHEETS[:3]:
        ws = book[name]
        assert ws.freeze_panes == "D9"
        assert (ws.page_setup.orientation, ws.page_setup.fitToWidth, ws.page_setup.fitToHeight) == (
            "landscape",
            1,
            0,
        )
        assert int(ws.page_setup.paperSize) == 9
        assert ws.sheet_properties.pageSetUpPr.fitToPage
        assert ws.print_title_rows == "$1:$8"
        assert ws.oddHeader.left.text == "Study"


def test_colour_scale_is_fixed(book: Workbook) -> None:
    ((area, rules),) = book["Influence"].conditional_formatting._cf_rules.items()
    scale = rules[0].colorScale
    assert [(p.type, p.val) for p in scale.cfvo] == [("num", -100), ("num", 0), ("num", 100)]
    assert scale.color[1].rgb.endswith("FFFFFF")
    assert str(area.sqref).startswith("D9:")


def test_nonlinear_cells_are_marked(tmp_path: Path) -> None:
    book = write(tmp_path / "n.xlsx", study([[10.0, 4.0], [5.0, 8.0]], exact=[[10.0, 4.0], [4.0, 8.0]]))
    marked, plain = (
        book["Influence"].cell(FIRST_MATRIX_ROW + 1, 4),
        book["Influence"].cell(FIRST_MATRIX_ROW, 4),
    )
    assert marked.font.italic and "exact 40.0 %" in marked.comment.text
    assert not plain.font.italic and plain.comment is None
    assert book["Exact"].cell(FIRST_MATRIX_ROW + 1, 4).fill.fgColor.rgb.endswith("FBE3F0")
    assert "(1 cells)" in book["Exact"]["A2"].value


def test_failed_axle_leaves_empty_cells_and_its_reason(tmp_path: Path) -> None:
    failed = study([[np.nan], [1.0]], failures={"P0.x": "no equilibrium: load case roll"})
    ws = write(tmp_path / "f.xlsx", failed)["Influence"]
    assert ws.cell(FIRST_MATRIX_ROW, 4).value is None
    assert "no equilibrium: load case roll" in ws.cell(FIRST_MATRIX_ROW, 7).value


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, "±1 mm"),
        ({"path": "llr.Fx", "unit": "-", "nominal": 1.0, "step": 0.1}, "±10 %"),
        ({"path": "spring.rate", "unit": "N/mm", "nominal": 28.0, "step": 2.8}, "±10 %"),
        ({"path": "arb.radius", "nominal": 11.5, "step": 1.15}, "±10 %"),
        ({"path": "static.toe", "unit": "deg", "nominal": 0.05, "step": 0.1}, "±0.1 deg"),
        ({"path": "strut.flexibility", "unit": "-", "lower": 0.0, "step": 0.1}, "+0.1"),
    ],
)
def test_step_as_the_user_thinks_of_it(changes: dict[str, object], expected: str) -> None:
    row = parameter(**{"path": "LLF.x", **changes})  # type: ignore[arg-type]
    assert step_text(study([[1.0]], parameters=(row,)), 0) == expected


@pytest.mark.parametrize("evil", EVIL)
def test_text_never_becomes_a_formula(tmp_path: Path, evil: str) -> None:
    rows = (parameter(evil, label=evil),)
    hostile = replace(
        study([[1.0]], parameters=rows, failures={evil: evil}),
        characteristics=(replace(CHARACTERISTICS["vertical.bump_steer"], id=evil, label=evil, unit=evil),),
    )
    book = write(tmp_path / "evil.xlsx", hostile, name=evil, notes={evil: evil})
    found = 0
    for ws in book:
        for cell in (c for row in ws.iter_rows() for c in row):
            assert cell.data_type != "f", f"{ws.title}!{cell.coordinate}"
            if cell.value == clean(evil):
                found += 1
                assert cell.data_type == "s" and cell.quotePrefix
    assert found >= 6


@pytest.mark.skipif(shutil.which("libreoffice") is None, reason="needs LibreOffice")
def test_libreoffice_calculates_nothing(tmp_path: Path) -> None:
    rows = tuple(parameter(evil, label=evil) for evil in EVIL[:4])
    write(tmp_path / "evil.xlsx", study([[4.0], [3.0], [2.0], [1.0]], parameters=rows))
    done = subprocess.run(
        ["libreoffice", f"-env:UserInstallation=file://{tmp_path}/profile", "--headless", "--convert-to",
         "csv:Text - txt - csv (StarCalc):44,34,76", "--outdir", str(tmp_path), str(tmp_path / "evil.xlsx")],
        capture_output=True, timeout=60, check=False,
    )  # fmt: skip
    if not (tmp_path / "evil.csv").exists():
        pytest.skip(f"LibreOffice does not run here: {done.stderr.decode()[:80]}")
    read = list(csv.reader(io.StringIO((tmp_path / "evil.csv").read_text(encoding="utf-8"))))
    assert [line[1] for line in read[FIRST_MATRIX_ROW - 1 : FIRST_MATRIX_ROW + 3]] == list(EVIL[:4])


def test_control_characters_are_replaced(tmp_path: Path) -> None:
    book = write(tmp_path / "x.xlsx", study([[1.0]]), name="a\x00b\x07 & c")
    assert "a\ufffdb\ufffd & c" in book["Influence"]["A1"].value
    assert book["Influence"].oddHeader.left.text == "a\ufffdb\ufffd && c"


def test_selection_sheet_without_measurement_says_what_is_needed(tmp_path: Path) -> None:
    ws = write(tmp_path / "x.xlsx", study([[1.0]]))["Selection"]
    assert any("--measurement DIR" in text for text in texts(ws))


def test_selection_sheet_lists_every_variable_and_target(book: Workbook) -> None:
    real = real_study()
    words = texts(book["Selection"])
    assert {p.path for p in real.parameters} <= set(words)
    assert {c.id for c in real.characteristics} <= set(words)


def test_relations_sheet_names_leaders_and_groups(book: Workbook) -> None:
    words = texts(book["Relations"])
    assert "llr.Fx  +100 %" in words
    assert "brake.wc_longitudinal_disp (opposite)" in words


def test_legend_explains_signs_windows_and_gives_date(book: Workbook) -> None:
    words = " ".join(texts(book["Legend"]))
    for needed in (
        "2026-01-31",
        "doe_kc",
        "toe-in +".capitalize(),
        "Vertical motion ±20 mm",
        "±10 %",
        "orange",
    ):
        assert needed in words


def test_unwritable_place_is_one_sentence_and_keeps_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "old.xlsx"
    path.write_bytes(b"old")

    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(RunError, match=r"old\.xlsx.*No space left.*free disk space"):
        write(path, study([[1.0]]))
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_folder_in_place_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "x.xlsx").mkdir()
    with pytest.raises(RunError, match=r"x\.xlsx"):
        write(tmp_path / "x.xlsx", study([[1.0]]))
