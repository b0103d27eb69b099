"""`tolerance` and `influence --global`: what they write, print and refuse."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.runner import fails, succeeds
from tests.reference import EXAMPLE

TABLES = """
seed = 3
pictures = "none"
[influence]
parameters = ["ROB.z", "llr.Fx"]
morris = 4
pawn = 50
[variables]
use = ["ROB.z", "llr.Fx"]
[tolerance]
samples = 40
parameters = ["ROB.z", "llr.Fx"]
[[tolerance.requirement]]
match = "vertical.bump_steer"
low = -4.5
high = -3.5
"""


@pytest.fixture
def study(tmp_path: Path) -> Path:
    (tmp_path / "axle.toml").write_bytes((EXAMPLE / "axle.toml").read_bytes())
    (tmp_path / "study.toml").write_text(f'axle = "axle.toml"\n{TABLES}', encoding="utf-8")
    return tmp_path


def test_tolerance(study: Path) -> None:
    file = study / "t.json"
    first = succeeds("tolerance", study, "--workers", "1", "--json", file)
    document = json.loads(file.read_text("utf-8"))
    assert document["samples"] == 40 and document["seed"] == 3 and document["failed"] == 0
    bump = document["characteristics"]["vertical.bump_steer"]
    assert bump["low"] == -4.5 and 0.0 < bump["outside_low"] < bump["outside"] < bump["outside_high"] < 1.0
    assert document["outside_any"]["share"] == bump["outside"]
    shares = document["contributions"]["first_order"]["vertical.bump_steer"]
    assert sum(shares.values()) == pytest.approx(1.0) and shares["ROB.z"] > 0.9
    assert document["tightening"]["ROB.z"]["outside_halved"] < bump["outside"]
    assert "Halving the scatter of ROB.z" in first.out and "41 solved now" in first.out
    names = {p.name for p in (study / "out" / "tolerance").iterdir()}
    assert names == {
        "tolerance.xlsx", "report.html", "characteristics.csv", "contributions.csv", "tightening.csv",
        "scatter.csv", "bands.csv", "cars.csv",
    }  # fmt: skip
    assert "(axle.toml);" in (study / "out" / "tolerance" / "report.html").read_text("utf-8")
    again = succeeds("tolerance", study, "--workers", "1", "--json", file)
    assert "0 solved now" in again.out
    repeated = json.loads(file.read_text("utf-8"))
    assert {**repeated, "seconds": 0, "conclusions": 0} == {**document, "seconds": 0, "conclusions": 0}
    assert "5 solved now" in succeeds("tolerance", study, "--workers", "1", "--samples", "45").out


def test_global_sensitivities(study: Path) -> None:
    file = study / "i.json"
    outcome = succeeds("influence", study, "--workers", "1", "--json", file, "--global", "morris,pawn")
    document = json.loads(file.read_text("utf-8"))["global"]
    assert document["morris"]["designs"] == 4 * 3 and document["pawn"]["designs"] == 50
    assert document["morris"]["mu_star"]["value"]["vertical.bump_steer"]["ROB.z"] > 1.0
    assert "Morris: 12 designs" in outcome.out and "PAWN: 50 designs" in outcome.out
    folder = study / "out" / "influence"
    assert "(axle.toml);" in (folder / "report.html").read_text("utf-8")
    assert (folder / "influence_global.csv").read_text("utf-8").startswith("name,load_case")
    from openpyxl import load_workbook

    sheets = load_workbook(folder / "influence.xlsx", read_only=True).sheetnames
    assert sheets[-4:] == ["Global", "Not linear", "Convergence", "Legend"]
    assert "Over the ranges" in (folder / "report.html").read_text("utf-8")
    unknown = r"--global: 'moris' is no method of global sensitivity; .* Did you mean \"morris\""
    fails(2, unknown, "influence", study, "--global", "moris")


BAD = {
    "samples": ("samples = 3", r"tolerance\.samples is 3, expected a number >= 30"),
    "law": ('distribution = "gauss"', r"tolerance\.distribution is 'gauss', expected 'normal', 'truncated"),
    "key": ("sample = 3", r"tolerance\.sample is unknown; .*samples"),
    "two sizes": (
        'scatter = [{match = "LLF.x", sd = 1.0, share = 0.1}]',
        "give one of sd, share and tolerance",
    ),
    "sd": ('scatter = [{match = "LLF.x", sd = -1.0}]', r"sd is -1\.0, expected a number >= 0"),
    "common": ("common = 1.5", r"tolerance\.common is 1\.5, expected a number <= 1"),
    "value": ('correlation = [{match = ["LLF.?"], value = 2.0}]', r"value is 2\.0, expected a number <= 1"),
    "limits": (
        'requirement = [{match = "static.toe", low = 1.0, high = 0.0}]',
        "low = 1 is not below high = 0",
    ),
    "no limit": ('requirement = [{match = "static.toe"}]', "give low, high or both"),
    "requirement": (
        'requirement = [{match = "static.tow", low = 1.0}]',
        r"'static\.tow' fits no characteristic",
    ),
    "glob": ('parameters = ["LLX.*"]', r"tolerance\.parameters: 'LLX\.\*' matches no parameter"),
    "cars": (
        'cars = ["rig_9"]',
        r"tolerance\.cars: .*rig_9: there is no such folder; expected one that holds",
    ),
    "psd": (
        'correlation = [{match = ["LLF.?"], value = -0.8}]',
        "no cars have all these correlations at once",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_tables(tmp_path: Path, name: str) -> None:
    table, pattern = BAD[name]
    (tmp_path / "axle.toml").write_bytes((EXAMPLE / "axle.toml").read_bytes())
    text = f'axle = "axle.toml"\npictures = "none"\n[tolerance]\n{table}\n'
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    for command in ("tolerance", "check"):
        fails(2, pattern, command, tmp_path)


def test_bad_methods_of_a_study(tmp_path: Path) -> None:
    (tmp_path / "axle.toml").write_bytes((EXAMPLE / "axle.toml").read_bytes())
    text = 'axle = "axle.toml"\n[influence]\nglobal = ["sobl"]\n'
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    fails(2, r"influence\.global\.0 is 'sobl', expected 'morris', 'sobol' or 'pawn'", "influence", tmp_path)
