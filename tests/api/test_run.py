"""The whole chain by the Python API."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pandas as pd
import pytest

import doe_kc as kc
from tests.api.cases import small_library
from tests.cli.runner import succeeds


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("out")


@pytest.fixture(scope="module")
def result(folder: Path, out: Path) -> kc.RunResult:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("doe_kc.workflow.discover.effect_library", small_library)
        return kc.run(folder, out=out, workers=1)


def test_the_answer(result: kc.RunResult) -> None:
    assert result.status == "sound" and len(result.reasons) == 1
    assert list(result.axle.effects) == ["hub_compliance"]
    assert result.discovery is not None and result.discovery.verdict == "named"
    assert result.characteristics["inside"].all() and result.to_frame() is result.characteristics
    assert result.comparison.characteristics["inside"].all()
    assert not result.reduction.characteristics.empty and len(result.influence.to_frame()) == 5
    assert "hub_compliance" in repr(result.axle) and len(repr(result)) < 700
    assert result.plot().get_lines() and len(result.parameters) == 7


def test_out_is_the_folder_of_the_command(result: kc.RunResult, folder: Path, out: Path) -> None:
    folders = {"compare", "correlate", "discover", "influence", "reduce", "simulate", "store"}
    assert {p.name for p in out.iterdir()} == folders | {
        "axle.toml",
        "summary.json",
        "index.html",
        "summary.pdf",
    }
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["status"], summary["verdict"]) == (result.status, "named")
    assert kc.read_axle(out / "axle.toml").effects == result.axle.effects
    assert not (folder / "out").exists()


def test_the_command_gives_the_same(
    result: kc.RunResult, folder: Path, out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every table digit for digit; from the same store, so that the search is not made again."""
    shutil.copytree(out / "store", tmp_path / "store")
    outcome = succeeds("run", folder, "--out", tmp_path, "--workers", "1")
    assert outcome.out.splitlines()[0] == result.lines[0]
    tables = sorted(p.relative_to(out) for p in out.rglob("*.csv"))
    assert tables == sorted(p.relative_to(tmp_path) for p in tmp_path.rglob("*.csv")) and len(tables) > 20
    assert [t for t in tables if _rows(out / t) != _rows(tmp_path / t)] == []
    assert _axle_text(out / "axle.toml") == _axle_text(tmp_path / "axle.toml")


def test_report_reads_it_back(result: kc.RunResult, folder: Path, out: Path) -> None:
    (out / "index.html").unlink()
    again = kc.report(folder, out=out)
    assert (out / "index.html").is_file() and again.status == result.status
    assert again.lines == result.lines and again.to_frame().equals(result.to_frame())
    assert again.comparison is not None and again.plot().get_lines()
    (out / "index.html").unlink()
    outcome = succeeds("report", folder, "--out", out)
    assert outcome.out.splitlines()[: len(again.lines)] == again.lines and (out / "index.html").is_file()


def test_a_run_that_is_interrupted_leaves_what_it_had(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("doe_kc.api.run.correlation_of", interrupted)
    with pytest.raises(KeyboardInterrupt):
        kc.run(folder, out=tmp_path, workers=1)
    assert {"simulate", "reduce", "influence", "discover", "store"} == {p.name for p in tmp_path.iterdir()}


def _rows(path: Path) -> list[str]:
    """Of a table, without the columns of seconds, which no two runs share."""
    frame = pd.read_csv(path, dtype=str)
    return frame.drop(columns=[c for c in frame if "seconds" in c]).to_csv().splitlines()


def _axle_text(path: Path) -> list[str]:
    return path.read_text().splitlines()[1:]
