"""Every way in which a record can be bad, and the sentence that says so."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import openpyxl
import pytest

from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.errors import InputError
from doe_kc.load_cases.roll import CounterPhaseRoll
from doe_kc.measurement import read_record
from tests.measurement.synthetic import EXAMPLE, csv_text, record_columns

TEXT = csv_text(record_columns("vertical", samples=128))


def written(folder: Path, text: str | bytes, name: str = "v.csv") -> Path:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def workbook(folder: Path, *titles: str, name: str = "v.xlsx") -> Path:
    book = openpyxl.Workbook()
    book.remove(book.active)
    for title in titles:
        sheet = book.create_sheet(title)
        for number, line in enumerate(TEXT.splitlines()):
            cells = line.split(",")
            sheet.append(cells if number == 0 else [float(c) for c in cells])
    path = folder / name
    book.save(path)
    return path


def test_a_shipped_record_is_read_with_caster_as_spin() -> None:
    record = read_record(EXAMPLE / "vertical.csv", "vertical")
    assert record.input.shape == (512,) and record.input[0] == 79.9921
    assert set(record.channels) == set(RIG_RESPONSES)
    assert record.channels["spin"][0, 0] == 0.5775
    assert record.channels["tyre_load"][1, 0] == 8757.7


def test_semicolons_with_decimal_comma_bom_and_crlf_are_read(tmp_path: Path) -> None:
    plain = read_record(written(tmp_path, TEXT), "vertical")
    german = TEXT.replace(",", ";").replace(".", ",").replace("\n", "\r\n")
    other = read_record(written(tmp_path, b"\xef\xbb\xbf" + german.encode(), "g.csv"), "vertical")
    np.testing.assert_array_equal(plain.channels["wc_z"], other.channels["wc_z"])


def test_extra_columns_and_another_order_do_not_matter(tmp_path: Path) -> None:
    columns = record_columns("vertical", samples=128)
    shuffled = {"note [-]": np.zeros(128)} | dict(reversed(columns.items()))
    record = read_record(written(tmp_path, csv_text(shuffled)), "vertical")
    np.testing.assert_allclose(record.input, columns["pad_z [mm]"], atol=1e-9)


@pytest.mark.parametrize(
    ("titles", "sheet"), [(("any",), None), (("x", "vertical"), None), (("a", "b"), "b")]
)
def test_an_excel_sheet_holds_the_same(tmp_path: Path, titles: tuple[str, ...], sheet: str | None) -> None:
    record = read_record(workbook(tmp_path, *titles), "vertical", sheet=sheet)
    plain = read_record(written(tmp_path, TEXT), "vertical")
    np.testing.assert_array_equal(record.channels["toe"], plain.channels["toe"])


def test_roll_by_counter_phase_pads_is_recognised(tmp_path: Path) -> None:
    columns = record_columns("roll", samples=128)
    columns = {k.replace("roll [deg]", "pad_z [mm]"): v for k, v in columns.items()}
    columns["pad_z [mm]"] = columns["pad_z [mm]"] * 15.0
    record = read_record(written(tmp_path, csv_text(columns)), "roll")
    assert isinstance(record.case, CounterPhaseRoll)


def _edit(old: str, new: str) -> Callable[[str], str]:
    return lambda text: text.replace(old, new, 1)


def _row(number: int, change: Callable[[str], str]) -> Callable[[str], str]:
    def edit(text: str) -> str:
        lines = text.split("\n")
        lines[number - 1] = change(lines[number - 1])
        return "\n".join(lines)

    return edit


def _constant(text: str) -> str:
    lines = text.splitlines()
    return "\n".join([lines[0], *(_second(line, "0") for line in lines[1:])]) + "\n"


def _second(line: str, value: str) -> str:
    cells = line.split(",")
    cells[1] = value
    return ",".join(cells)


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (_edit("toe_L [deg]", "toe_left [deg]"), ['"toe_L [deg]"', 'is it the column "toe_left"']),
        (_edit("caster_R [deg]", "x"), ["lacks", '"caster_R [deg]"', "load case vertical"]),
        (_edit("toe_L [deg]", "toe_L [N]"), ["column 3", "[N]", "[deg]", "unit ="]),
        (_edit("wc_x_R [mm]", "wc_x_R [fathom]"), ["[fathom]", "[mm]", "inch"]),
        (_edit("camber_L [deg]", "camber_L"), ["camber_L", "no unit", "[deg]"]),
        (_edit("camber_L [deg]", "toe_L [deg]"), ["camber_L"]),
        (_edit("camber_R [deg]", "toe_R [deg]"), ["camber_R"]),
        (_edit("time [s],", "time [s];"), ["row 2 has 16 columns, expected 15"]),
        (_row(7, lambda line: _second(line, "NaN")), ["row 7", "pad_z", '"NaN"', "finite number"]),
        (_row(7, lambda line: _second(line, "")), ["row 7", "pad_z", "is empty"]),
        (_row(9, lambda line: _second(line, "1e999")), ["row 9", "1e999"]),
        (_row(9, lambda line: _second(line, "1_0")), ["row 9", "1_0"]),
        (_row(9, lambda line: _second(line, "5 mm")), ["row 9", "5 mm"]),
        (_row(12, lambda line: line + ",1"), ["row 12 has 17 columns", "expected 16"]),
        (lambda t: t[: len(t) - 60], ["row 129, the last one", "truncated"]),
        (lambda t: "\n".join(t.split("\n")[:20]), ["19 samples", "at least 24"]),
        (lambda t: t.split("\n")[0], ["0 samples"]),
        (_constant, ["pad_z [mm]", "constant at 0", "±20"]),
        (_row(5, lambda line: "0" + line[line.index(",") :]), ["row 5", "time does not increase"]),
        (lambda t: t.replace(",", "|"), ["no rows of numbers", "commas, semicolons, tabs or blanks"]),
        (lambda t: t.split("\n", 1)[1], ["row 1", "without a row of headings"]),
        (lambda _: "", ["empty"]),
        (lambda _: "\n \n", ["empty"]),
    ],
)
def test_a_bad_record_is_refused_in_one_sentence(
    tmp_path: Path, edit: Callable[[str], str], words: list[str]
) -> None:
    path = written(tmp_path, edit(TEXT))
    with pytest.raises(InputError) as caught:
        read_record(path, "vertical")
    message = str(caught.value)
    assert str(path) in message
    for word in words:
        assert word in message, message


def test_a_column_named_twice_is_refused(tmp_path: Path) -> None:
    columns = record_columns("vertical", samples=128)
    text = csv_text(columns | {"toe_L": columns["toe_L [deg]"]})
    with pytest.raises(InputError, match="columns 3 and 17 are both named"):
        read_record(written(tmp_path, text), "vertical")


def test_a_sweep_short_of_the_fit_window_is_refused(tmp_path: Path) -> None:
    columns = record_columns("vertical", samples=128)
    columns["pad_z [mm]"] = columns["pad_z [mm]"] * 0.2
    with pytest.raises(InputError, match=r"covers -16 to 16, expected at least ±20"):
        read_record(written(tmp_path, csv_text(columns)), "vertical")


@pytest.mark.parametrize(
    ("data", "name", "words"),
    [
        (b"PK\x03\x04rest", "v.csv", "Excel workbook named .csv"),
        (b"\xd0\xcf\x11\xe0rest", "v.csv", "Excel workbook"),
        (b"a,b\x00,c\n", "v.csv", "binary data"),
        (b"\xff\xfe\x01", "v.csv", "byte 2 is no text"),
        (TEXT.encode(), "v.xlsx", "is not an Excel workbook"),
        (b"PK\x03\x04rest", "v.xlsx", "cannot be read as an Excel workbook"),
        (TEXT.encode(), "v.xls", "old Excel format"),
    ],
)
def test_files_in_disguise_are_refused(tmp_path: Path, data: bytes, name: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_record(written(tmp_path, data, name), "vertical")


def test_missing_files_folders_and_sheets_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read_record(tmp_path / "v.csv", "vertical")
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(InputError, match="cannot be read"):
        read_record(tmp_path / "folder.csv", "vertical")
    with pytest.raises(InputError, match=r'no sheet "verticl".*Did you mean "vertical"'):
        read_record(workbook(tmp_path, "vertical", "roll"), "vertical", sheet="verticl")
    with pytest.raises(InputError, match=r"no .xlsx"):
        read_record(written(tmp_path, TEXT), "vertical", sheet="a")


def test_an_empty_excel_cell_is_named(tmp_path: Path) -> None:
    path = workbook(tmp_path, "vertical")
    book = openpyxl.load_workbook(path)
    book["vertical"]["C9"] = None
    book["vertical"]["D9"] = "=A1"
    book.save(path)
    with pytest.raises(InputError, match=r'v.xlsx#vertical: row 9, column "toe_L \[deg\]" is empty'):
        read_record(path, "vertical")
