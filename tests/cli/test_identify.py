"""`doe-kc identify`: a table of another model to an axle file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from doe_kc.axle import parameter_value
from doe_kc.axle_file import read_axle
from tests.cli.runner import AXLE, invoke, succeeds
from tests.identification.cases import CAR, FREE, car_matrix

FREED = [word for glob, sd in FREE.items() for word in ("--free", f"{glob}={sd}")]


@pytest.mark.parametrize("form", ["csv", "xlsx"])
def test_a_table_becomes_an_axle(form: str, tmp_path: Path) -> None:
    file = tmp_path / f"supplier.{form}"
    frame = car_matrix().round(3).rename(index=lambda p: p.replace(".", " ")).astype(object)
    frame.iloc[0, 0] = None
    if form == "csv":
        frame.to_csv(file, sep=";")
    else:
        frame.to_excel(file)
    done = succeeds(
        "identify", file, AXLE, *FREED, "--mask", "ROB.x:lateral.*", "--starts", 1, "--workers", 1,
        "--noise", 0.001, "--out", tmp_path / "out", "--json", tmp_path / "numbers.json",
        "--pictures", "none",
    )  # fmt: skip
    assert "mean correlation of the columns 1.000" in done.out and "wrote" in done.err
    axle = read_axle(tmp_path / "out" / "axle.toml")
    for path, value in CAR.items():
        assert parameter_value(axle, path) == pytest.approx(value, rel=3e-3), path
    document = json.loads((tmp_path / "numbers.json").read_text("utf-8"))
    assert document["agreement"]["lateral.toe_change"]["cells"] == 11
    assert document["parameters"]["llr.Fx"]["identified"] == pytest.approx(0.6, rel=3e-3)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--free", "LLF.*=wide"], "'wide' is not a number; expected GLOB or GLOB=SD"),
        (["--mask", "upb.Tz"], "expected PARAMETER:CHARACTERISTIC"),
        (["--mask", "upb.Tz:*"], "meets no cell"),
        (["--noise", "2"], "noise is 2.0, expected a share"),
    ],
)
def test_bad_options_end_in_a_sentence(arguments: list[str], words: str, tmp_path: Path) -> None:
    car_matrix().to_csv(tmp_path / "m.csv")
    done = invoke("identify", tmp_path / "m.csv", AXLE, *arguments)
    assert done.code == 2 and words in done.err and "Traceback" not in done.err


def test_bad_tables_end_in_a_sentence(tmp_path: Path) -> None:
    done = invoke("identify", tmp_path / "none.csv", AXLE)
    assert done.code == 2 and "there is no such table" in done.err
    (tmp_path / "m.csv").write_text("parameter,drive.drive_steer\nLLF.x,a lot\nLLR.x,1\n", encoding="utf-8")
    done = invoke("identify", tmp_path / "m.csv", AXLE)
    assert done.code == 2 and "row 'LLF.x', column 'drive.drive_steer' is 'a lot'" in done.err
