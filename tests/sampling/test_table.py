"""A user's table of designs, and what can be wrong with one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.sampling import Design, sample
from doe_kc.variables import Change, VariableOptions, build_space
from tests.reference import nominal

SPACE = build_space(
    nominal(),
    VariableOptions(
        use=["LLF.z", "llr.Fx", "spring.rate"], change=[Change(match="LLF.z", range=[205.0, 215.0])]
    ),
    "test",
)


def read(path: Path) -> Design:
    return sample(SPACE, 1, seed=1, method="table", table=path)


def written(folder: Path, text: str) -> Path:
    path = folder / "designs.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_values_as_they_are_and_the_rest_at_its_start(tmp_path: Path) -> None:
    design = read(written(tmp_path, "label,llr.Fx, LLF.z \nsoft,0.71234567,206.5\n,2,215\n"))
    rows = list(design.rows())
    assert rows[0]["llr.Fx"] == pytest.approx(0.71234567, rel=1e-14) and rows[0]["LLF.z"] == 206.5
    assert rows[1]["llr.Fx"] == pytest.approx(2.0) and rows[1]["LLF.z"] == 215.0
    assert rows[0]["spring.rate"] == pytest.approx(SPACE.variables[2].start)
    assert design.labels == ("soft", "") and design.seed is None


def test_a_workbook_and_other_separators(tmp_path: Path) -> None:
    frame = pd.DataFrame({"LLF.z": [206.0, 207.0], "llr.Fx": [0.5, 1.0]})
    frame.to_excel(tmp_path / "d.xlsx", index=False)
    semicolons = written(tmp_path, "LLF.z;llr.Fx\n206;0.5\n207;1\n")
    np.testing.assert_allclose(read(tmp_path / "d.xlsx").values, read(semicolons).values)
    assert read(semicolons).labels == ("row 2", "row 3")


def test_designs_that_were_evaluated_are_read_without_their_results(tmp_path: Path) -> None:
    design = sample(SPACE, 3, seed=1)
    frame = pd.DataFrame(list(design.rows()))[list(SPACE.paths)]
    frame.insert(0, "label", list(design.labels))
    evaluated = frame.assign(status="ok", reason="", seconds=0.1, **{"vertical.bump_steer": -3.0})
    evaluated.to_csv(tmp_path / "designs.csv", index=False)
    again = read(tmp_path / "designs.csv")
    np.testing.assert_allclose(again.values, design.values, rtol=1e-12)
    assert again.labels == design.labels
    unknown = evaluated.drop(columns="status")
    unknown.to_csv(tmp_path / "designs.csv", index=False)
    with pytest.raises(InputError, match=r"column 5, 'reason', is not a variable"):
        read(tmp_path / "designs.csv")


def test_tied_and_fixed_parameters_may_stand_beside_with_their_values(tmp_path: Path) -> None:
    tied = build_space(
        nominal(),
        VariableOptions(
            use=["LLF.z", "llr.Fx"],
            change=[Change(match="LLR.z", tie="LLF.z"), Change(match="tyre.rate", fixed=210.0)],
        ),
        "test",
    )
    design = sample(tied, 3, seed=1)
    assert {"LLR.z", "tyre.rate"} < set(design.paths)
    path = tmp_path / "designs.csv"
    frame = pd.DataFrame(list(design.rows()))
    frame.to_csv(path, index=False, float_format="%.10g")
    again = sample(tied, 1, seed=1, method="table", table=path)
    np.testing.assert_allclose(again.values, design.values, rtol=1e-9)
    for column, value in (("LLR.z", frame["LLR.z"][1] + 0.001), ("tyre.rate", 211.0), ("tyre.rate", None)):
        other = frame.copy()
        other.loc[1, column] = value
        other.to_csv(path, index=False)
        with pytest.raises(InputError, match=rf"row 3, column {column}: .*ties or fixes it to"):
            sample(tied, 1, seed=1, method="table", table=path)
    frame[["LLR.z"]].to_csv(path, index=False)
    with pytest.raises(InputError, match="has no column of a variable"):
        sample(tied, 1, seed=1, method="table", table=path)


@pytest.mark.parametrize(
    ("text", "pattern"),
    [
        ("LLF.z,LLF.q\n206,1\n", r"column 2, 'LLF\.q', is not a variable.*Did you mean \"LLF\.z\""),
        ("LLF.z,LLR.z\n206,200\n", r"column 2, 'LLR\.z', is not a variable"),
        ("LLF.z,llr.Fx\n206,1\n207,\n", r"row 3, column llr\.Fx: the value is missing"),
        ("LLF.z,llr.Fx\n206,1\n207\n", r"row 3, column llr\.Fx: the value is missing"),
        ("LLF.z,llr.Fx\nnan,1\n", r"row 2, column LLF\.z: (the value is missing|nan)"),
        ("LLF.z,llr.Fx\n206,1\n207,1\n208,inf\n", r"row 4, column llr\.Fx: inf, expected a finite"),
        ("LLF.z,llr.Fx\n206,soft\n", r"row 2, column llr\.Fx: 'soft' is not a number"),
        (
            "LLF.z,llr.Fx\n206,1\n215.1,1\n",
            r"row 3, column LLF\.z: 215\.1 is outside the bounds \[205, 215\]",
        ),
        ("LLF.z,llr.Fx\n206,0\n", r"row 2, column llr\.Fx: 0 is outside the bounds \[0\.5, 2\]"),
        ("LLF.z\n206.5\n207,5\n", "row 3|is not a table"),
        ("label\nsoft\n", "has no column of a variable"),
        ("LLF.z,llr.Fx\n", "has no row below its header"),
        ("", "is not a table"),
    ],
)
def test_what_is_wrong_is_named_with_row_and_column(tmp_path: Path, text: str, pattern: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(InputError, match=pattern) as error:
        read(path)
    assert str(error.value).startswith(str(path))


def test_files_that_are_no_table(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"there is no such table"):
        read(tmp_path / "none.csv")
    with pytest.raises(InputError, match="is a folder"):
        read(tmp_path)
    for name in ("bad.xlsx", "bad.csv"):
        (tmp_path / name).write_bytes(bytes(range(256)))
        with pytest.raises(InputError, match="is not a table"):
            read(tmp_path / name)
    with pytest.raises(InputError, match="needs a file"):
        sample(SPACE, 1, seed=1, method="table")
