"""The reports on correlation: the reduced versions run, assert their figures and go on from a cache."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pandas as pd
import pytest

REPORTS = Path(__file__).parents[2] / "reports"
everyone = pytest.mark.parametrize("name", ["correlated_cars", "recorrelation", "configurations"])


@pytest.fixture
def reports(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(REPORTS))


@everyone
def test_reduced_report_holds_and_is_resumed(
    name: str,
    reports: None,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    report = importlib.import_module(name)
    cache, out = tmp_path / "cache", tmp_path / "out"
    monkeypatch.setattr(sys, "argv", [name, "--quick", "--cache", str(cache), "--out", str(out)])
    report.main()
    assert " done" in capsys.readouterr().out
    text = (out / f"{name}.md").read_text(encoding="utf-8")
    pictures = {p.name for p in out.glob("*.png")}
    assert pictures
    assert all(f"({p})" in text for p in pictures)
    report.main()  # everything from the cache
    assert " done" not in capsys.readouterr().out
    assert (out / f"{name}.md").read_text(encoding="utf-8") == text


@everyone
def test_committed_report_is_of_the_whole_plan(name: str, reports: None) -> None:
    plan = importlib.import_module(name).Plan()
    table = pd.concat(
        [pd.read_csv(f) for f in [*REPORTS.glob(f"{name}_runs.csv"), *REPORTS.glob(f"{name}.csv")]]
    )
    assert table["seed"].max() == plan.seeds
    text = (REPORTS / f"{name}.md").read_text(encoding="utf-8")
    for picture in REPORTS.glob(f"{name}*.png"):
        assert f"({picture.name})" in text
    assert "nan" not in text.split()
