"""`doe-kc surrogates`: from the store to tables and figures; and the designs that it takes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from openpyxl import load_workbook

from doe_kc.campaign.store import read_store
from doe_kc.study import read_study
from doe_kc.surrogate_models.designs import designs_in_space, place
from doe_kc.surrogate_models.influence import agreement
from doe_kc.workflow import surrogates as workflow
from tests.cli.runner import fails, leftovers, succeeds, write_study

VARIABLES = """
[variables]
use = ["LLF.z", "llr.Fx", "RIB.z"]
[[variables.change]]
match = "RIB.z"
distribution = "gaussian"
"""
N = 24


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of three variables, 24 of its designs in the store."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DOE_KC_COMPILE", "0")
        folder = write_study(tmp_path_factory.mktemp("study"), extra=VARIABLES)
        succeeds("sample", folder, "--n", N, "--workers", 1)
    return folder


@pytest.fixture(autouse=True)
def interpreted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DOE_KC_COMPILE", "0")


@pytest.fixture(scope="module")
def result(study: Path) -> dict[str, object]:
    path = study / "result.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DOE_KC_COMPILE", "0")
        patch.setattr(workflow, "write_surrogate_figures", lambda *_a, **_k: [])
        outcome = succeeds("surrogates", study, "--json", path, "--workers", 1, "--models", "linear,gp")
    assert f"{N} designs, 0 failed and 0 of other variables" in outcome.out
    assert "correlation" in outcome.out
    found: dict[str, object] = json.loads(path.read_text())
    return found


def test_the_document_holds_everything(result: dict[str, object]) -> None:
    assert result["designs"] == N
    assert set(result["models"]) == {"linear", "gp"}  # type: ignore[call-overload]
    chosen = result["chosen"]
    assert set(chosen.values()) <= {"linear", "gp"}  # type: ignore[attr-defined]
    steer = result["models"]["gp"]["characteristics"]["vertical.bump_steer"]  # type: ignore[index]
    assert steer["q2"] > 0.99
    assert steer["unit"] == "deg/m"
    assert result["agreement"]["vertical.bump_steer"]["correlation"] > 0.99  # type: ignore[index]
    shares = result["shares"]["vertical.bump_steer"]  # type: ignore[index]
    assert set(shares) == {"LLF.z", "llr.Fx", "RIB.z"}
    assert sum(shares.values()) == pytest.approx(1.0, abs=0.1)


def test_tables_are_written(study: Path, result: dict[str, object]) -> None:
    folder = study / "out" / "surrogates"
    tables = {f"{name}.csv" for name in ("quality", "predictions", "influence", "shares", "learning_curve")}
    assert {p.name for p in folder.iterdir()} == {"surrogates.xlsx", "surrogate.npz", "evaluator"} | tables
    assert not leftovers(study)
    assert load_workbook(folder / "surrogates.xlsx").sheetnames == [
        "Quality",
        "Quality chart",
        "Learning curve",
        "Designs chart",
        "Influence",
        "Shares",
        "Legend",
    ]
    quality = pd.read_csv(folder / "quality.csv")
    assert (quality.groupby("characteristic")["chosen"].sum() == 1).all()
    predictions = pd.read_csv(folder / "predictions.csv")
    one = predictions[predictions["characteristic"] == "vertical.bump_steer"]
    assert len(one) == N
    assert np.corrcoef(one["true"], one["predicted"])[0, 1] > 0.99
    assert result["designs"] == N


def test_too_few_designs_say_how_many_and_how(study: Path, tmp_path: Path) -> None:
    wanted = r"holds 0 designs .* at least 10 and do well with 10; run doe-kc sample .* --n 10 first"
    fails(2, wanted, "surrogates", study, "--out", tmp_path)
    fails(2, "'forest' is no surrogate", "surrogates", study, "--models", "forest")


def test_a_design_counts_that_lies_in_the_space(study: Path) -> None:
    found = read_study(study)
    space, axle = found.space, found.axle
    middle = space.values(np.full(3, 0.5))
    assert place(middle, space, axle) == pytest.approx([0.5] * 3)
    assert place({}, space, axle) == pytest.approx(space.start)
    assert place(middle | {"LLF.x": axle_value(found.axle, "LLF.x")}, space, axle) is not None
    assert place(middle | {"LLF.x": 99.0}, space, axle) is None
    assert place(middle | {"LLF.z": 500.0}, space, axle) is None
    with read_store(found.store) as store:
        designs = designs_in_space(store, space, axle, found.windows)
    assert designs.x.shape == (N, 3)
    assert (designs.failed, designs.elsewhere) == (0, 0)
    assert np.isfinite(designs.y).all()


def axle_value(axle, path: str) -> float:  # type: ignore[no-untyped-def]
    from doe_kc.axle.parameters import parameter_value

    return parameter_value(axle, path)


def test_agreement_of_the_same_and_of_the_opposite() -> None:
    values = np.array([[1.0, 1.0], [-2.0, -2.0], [0.01, 0.5], [np.nan, 1.0]])
    same = agreement(np.nan_to_num(values), values)
    assert same.correlation == pytest.approx([1.0, 1.0])
    assert same.same_sign == pytest.approx([1.0, 1.0])
    assert same.error == pytest.approx([0.0, 0.0])
    assert agreement(-np.nan_to_num(values), values).same_sign == pytest.approx([0.0, 0.0])
