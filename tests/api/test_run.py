"""The whole chain by the Python API."""

from __future__ import annotations

import json
from pathlib import Path

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
    assert {p.name for p in out.iterdir()} == folders | {"axle.toml", "summary.json", "index.html"}
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["status"], summary["verdict"]) == (result.status, "named")
    assert kc.read_axle(out / "axle.toml").effects == result.axle.effects
    (out / "index.html").unlink()
    outcome = succeeds("report", folder, "--out", out)
    assert outcome.out.startswith("Sound: ") and (out / "index.html").is_file()
    assert not (folder / "out").exists()
