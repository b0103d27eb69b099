"""init, check, reduce, influence and run: what they write and print."""

from __future__ import annotations

import csv
import json
import shutil
import tomllib
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from doe_kc.examples import EXAMPLE_TYPES
from doe_kc.load_cases import CASE_ORDER
from doe_kc.reports.comparison import figures as comparison_figures
from doe_kc.reports.measurement import figures as rig_figures
from doe_kc.workflow.discover import effect_library
from tests.cli.runner import FEW, SHORT, Outcome, fails, invoke, leftovers, succeeds, write_study
from tests.reference import EXAMPLE, nominal

LATERAL = {"lateral": ("lateral.csv", "lateral_repeat1.csv")}
PUBLISHED = Path(__file__).parents[1] / "data" / "appendix_c_influence.csv"


def appendix_c_columns() -> list[str]:
    with PUBLISHED.open(newline="") as file:
        return next(csv.reader(file))[1:]


@pytest.mark.parametrize(
    ("command", "options"),
    [
        ("init", ["DIR", "--type"]),
        ("check", ["STUDY", "--measurement", "--out"]),
        ("simulate", ["AXLE", "--set", "--effect", "--case", "--roll", "--kinematic", "--out", "--json"]),
        ("reduce", ["STUDY", "--measurement", "--out", "--json"]),
        ("influence", ["STUDY", "--measurement", "--out", "--json", "--seed", "--workers"]),
        ("run", ["STUDY", "--measurement", "--out", "--json", "--seed", "--workers"]),
    ],
)
def test_help_names_every_option(command: str, options: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "120")
    outcome = succeeds(command, "--help")
    assert outcome.err == ""
    for option in options:
        assert option in outcome.out, option
    assert command in succeeds("--help").out


def test_init_writes_the_example_and_check_finds_it_sound(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "study"
    outcome = succeeds("init", folder)
    ours = {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
    theirs = {
        p.relative_to(EXAMPLE): p.read_bytes()
        for p in EXAMPLE.rglob("*")
        if p.is_file() and "out" not in p.relative_to(EXAMPLE).parts
    }
    assert ours == theirs
    assert outcome.out.startswith(f"{len(ours)} files in {folder}")

    checked = succeeds("check", folder)
    assert succeeds("check", folder / "study.toml").out == checked.out
    for word in ("Front axle, car_a", *CASE_ORDER, "car_a: 24 records, 8 load cases", "all sound"):
        assert word in checked.out
    assert not (folder / "out").exists()


def test_init_takes_an_empty_folder_and_no_other(tmp_path: Path) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    succeeds("init", empty)
    before = sorted(empty.rglob("*"))
    fails(2, "not an empty folder", "init", empty)
    assert sorted(empty.rglob("*")) == before
    file = tmp_path / "file"
    file.write_text("mine")
    fails(2, "not an empty folder", "init", file)
    assert file.read_text() == "mine"


@pytest.mark.parametrize("axle_type", EXAMPLE_TYPES)
def test_init_writes_a_sound_study_of_every_type(axle_type: str, tmp_path: Path) -> None:
    outcome = succeeds("init", tmp_path / "new", "--type", axle_type)
    study = tmp_path / "new" / "study.toml"
    command = "run" if (study.parent / "rig").is_dir() else "influence"
    assert outcome.out.rstrip().endswith(f"next: doe-kc {command} {study}")
    assert "all sound" in succeeds("check", study).out
    written = tomllib.loads((study.parent / "axle.toml").read_text())
    assert written.get("type", "mcpherson_front") == axle_type


def test_init_names_the_types_that_have_an_example(tmp_path: Path) -> None:
    words = "'five_links' is no axle type.*mcpherson_front.*Did you mean .five_link_rear"
    fails(2, words, "init", tmp_path / "new", "--type", "five_links")
    assert not (tmp_path / "new").exists()


def test_check_tells_effects_and_the_parameters_selected(tmp_path: Path) -> None:
    study = write_study(tmp_path, parameters=["LLF.*", "llr.F?"])
    with (study / "axle.toml").open("a") as file:
        file.write("\n[effects.hub_compliance]\n")
    out = succeeds("check", study, "--out", tmp_path / "elsewhere").out
    assert "hub_compliance" in out and "6 selected" in out and "none named" in out
    assert str(tmp_path / "elsewhere") in out


@pytest.fixture(scope="module")
def reduced(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A study of two load cases after `reduce`, undrawn; and its standard output."""
    folder = tmp_path_factory.mktemp("reduced")
    study = write_study(folder, records={"vertical": ("vertical.csv",)} | LATERAL)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rig_figures, "write_rig_figures", lambda *_, **__: [])
        patch.setattr(comparison_figures, "write_comparison_figures", lambda *_, **__: [])
        outcome = succeeds("reduce", study, "--out", folder / "results", "--json", folder / "r.json")
    return folder, outcome.out


def test_reduce_writes_targets_and_comparison(reduced: tuple[Path, str]) -> None:
    folder, out = reduced
    tables = {p.stem: pd.read_csv(p) for p in (folder / "results" / "reduce").glob("*.csv")}
    assert set(tables) == {"curves", "characteristics", "gradients", "noise"}
    assert set(tables["curves"]["load_case"]) == {"vertical", "lateral"}
    comparison = pd.read_csv(folder / "results" / "compare" / "characteristics.csv")
    assert set(comparison["load_case"]) == {"static", "vertical", "lateral"}
    assert {"name", "unit", "model", "target", "difference", "low", "high"} <= set(comparison.columns)
    difference = comparison["model"] - comparison["target"]
    pd.testing.assert_series_equal(comparison["difference"], difference, check_names=False, rtol=1e-6)
    curves = pd.read_csv(folder / "results" / "compare" / "curves.csv")
    assert len(curves) == 2 * 7 * 2 and (curves["rms"] >= 0).all()
    assert "vertical.bump_steer" in out and "ride height: measured car" in out
    assert "brake" not in out
    assert not (folder / "out").exists() and not leftovers(folder)


def test_reduce_writes_its_figures_as_json(reduced: tuple[Path, str]) -> None:
    folder, _ = reduced
    document = json.loads((folder / "r.json").read_text())
    table = pd.read_csv(folder / "results" / "reduce" / "characteristics.csv")
    assert set(document["characteristics"]) == set(table.iloc[:, 0])
    assert abs(document["ride_height_mm"]["estimate"]) < 5.0
    assert document["noise"]


def test_reduce_draws_one_figure_a_load_case(tmp_path: Path) -> None:
    study = write_study(tmp_path, records=LATERAL)
    succeeds("reduce", study)
    for name in ("reduce/rig_lateral.png", "compare/compare_lateral.png"):
        assert (study / "out" / name).read_bytes().startswith(b"\x89PNG")
    assert len(list((study / "out").rglob("*.png"))) == 2


def numbers(document: dict[str, Any]) -> dict[str, Any]:
    """What does not depend on the clock."""
    return {k: v for k, v in document.items() if k != "seconds"}


@pytest.mark.usefixtures("undrawn")
def test_influence_is_the_same_with_one_worker_and_two(tmp_path: Path) -> None:
    study = write_study(tmp_path)
    results = []
    for workers in (1, 2):
        file, out = tmp_path / f"{workers}.json", tmp_path / f"out{workers}"
        outcome = succeeds("influence", study, "--workers", workers, "--json", file, "--out", out)
        results.append(json.loads(file.read_text()))
        assert (out / "influence" / "influence.xlsx").read_bytes().startswith(b"PK")
    assert numbers(results[0]) == numbers(results[1])
    check_influence(results[0], outcome.out)
    for name in ("percent", "absolute", "exact"):
        files = [tmp_path / f"out{w}" / "influence" / f"influence_{name}.csv" for w in (1, 2)]
        assert files[0].read_bytes() == files[1].read_bytes()
        frame = pd.read_csv(files[0], index_col="parameter")
        assert list(frame.columns) == appendix_c_columns() and list(frame.index) == ordered(FEW, frame)
    assert not leftovers(tmp_path)


def ordered(paths: tuple[str, ...], frame: pd.DataFrame) -> list[str]:
    assert set(frame.index) == set(paths)
    return list(frame.index)


def check_influence(document: dict[str, Any], out: str) -> None:
    """Shape and sense of `influence --json`."""
    assert {"percent", "absolute", "exact", "seconds"} <= set(document)
    for name in ("percent", "absolute", "exact"):
        assert list(document[name]) == appendix_c_columns()
        assert all(set(column) == set(FEW) for column in document[name].values())
    for name, column in document["percent"].items():
        assert max(abs(v) for v in column.values()) == pytest.approx(100.0), name
        assert column["steer_arm.radius"] == 0.0
        assert f"\n{name} " in out
    assert document["steps"] == pytest.approx(
        {"LLF.z": 1.0, "llr.Fx": 0.1, "strut.flexibility": 0.1, "steer_arm.radius": 1.4}
    )
    assert document["failures"] == {} and document["seconds"] > 0
    bump = {name: document[name]["vertical.bump_steer"]["LLF.z"] for name in ("absolute", "exact")}
    assert bump["exact"] == pytest.approx(bump["absolute"], rel=0.05) and abs(bump["exact"]) > 0.1
    assert "4 parameters x 21 characteristics" in out


@pytest.mark.usefixtures("undrawn")
def test_run_does_the_whole_chain(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    few = effect_library(nominal())[:3]  # the others have tests of their own
    monkeypatch.setattr("doe_kc.workflow.discover.effect_library", lambda *_: few)
    study = write_study(tmp_path, records=LATERAL, tables=SHORT)
    outcome = invoke("run", study, "--json", tmp_path / "r.json", "--workers", 1, "--seed", 3)
    document = json.loads((tmp_path / "r.json").read_text())
    assert outcome.code == (1 if document["status"] == "not_usable" else 0), outcome.err
    steps = {"simulate", "reduce", "compare", "influence", "correlate", "discover"}
    head = {
        "status", "reasons", "axle", "verdict", "effects", "characteristics", "gap", "rating",
        "mean_improvement_percent", "seconds",
    }  # fmt: skip
    assert set(document) == steps | head
    check_influence(document["influence"], outcome.out)
    assert len(document["simulate"]["characteristics"]) == 30
    out = study / "out"
    assert {p.name for p in out.iterdir() if p.is_file()} == {
        "axle.toml",
        "index.html",
        "summary.json",
        "summary.pdf",
    }
    files = {str(p.relative_to(out)) for p in out.rglob("*") if p.is_file()}
    assert {
        "simulate/curves.csv",
        "simulate/characteristics.csv",
        "simulate/report.html",
        "reduce/report.html",
        "compare/report.html",
        "influence/report.html",
        "reduce/curves.csv",
        "compare/characteristics.csv",
        "influence/influence.xlsx",
        "correlate/axle.toml",
        "correlate/report.html",
        "discover/axle.toml",
        "discover/discovery.xlsx",
        "discover/report.html",
        "store/evaluations.sqlite",
        "store/discovery.sqlite",
    } <= files
    assert document["discover"]["verdict"] == document["verdict"] in {"named", "class", "none", "unexplained"}
    line = outcome.out.splitlines()[0]
    labels = {"sound": "Sound: ", "doubtful": "Doubtful: ", "not_usable": "Not usable: "}
    assert line == labels[document["status"]] + " ".join(document["reasons"])
    assert (out / "axle.toml").read_text().splitlines()[0].count(line) == 1
    summary = json.loads((out / "summary.json").read_text())
    assert set(summary) == head and summary["reasons"] == document["reasons"]
    unlisted = {f for f in files if f.startswith("store/")} | {"correlate/run.json"}
    assert f"{len(files - unlisted)} files under" in outcome.out and not leftovers(tmp_path)
    the_report_rebuilds_the_answer(study, outcome)


def the_report_rebuilds_the_answer(study: Path, run: Outcome) -> None:
    """Byte for byte, from what is stored."""
    out = study / "out"
    names = (
        "axle.toml",
        "summary.json",
        "index.html",
        "summary.pdf",
        "correlate/axle.toml",
        "compare/characteristics.csv",
    )
    written = {name: (out / name).read_bytes() for name in names}
    store = {p.name: p.read_bytes() for p in (out / "store").glob("*.sqlite")}
    for name in names:
        (out / name).unlink()
    again = succeeds("report", study)
    assert {name: (out / name).read_bytes() for name in names} == written
    assert {p.name: p.read_bytes() for p in (out / "store").glob("*.sqlite")} == store
    assert again.out.splitlines()[:2] == run.out.splitlines()[:2]
    assert f"The answer: {out / 'axle.toml'}" in again.out


def test_another_measurement_takes_the_place_of_the_studys(tmp_path: Path) -> None:
    study = write_study(tmp_path, records=LATERAL)
    other = write_study(tmp_path / "other", records={"brake": ("brake.csv",)}) / "rig"
    assert "1 records, 1 load cases" in succeeds("check", study, "--measurement", other).out
    assert "2 records, 1 load cases" in succeeds("check", study).out
    shutil.rmtree(study / "rig")
    assert "small" in succeeds("check", study, "--measurement", other / "test.toml").out


def test_without_a_command_the_help_is_shown() -> None:
    outcome = invoke()
    assert outcome.code in {0, 2} and "simulate" in outcome.out + outcome.err
