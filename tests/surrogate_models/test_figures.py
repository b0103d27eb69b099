"""The figures show every characteristic, in its unit, with nothing cut off."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.reports.surrogate_figures import (
    model_quality,
    predicted_against_true,
    residuals,
    write_surrogate_figures,
)
from doe_kc.surrogate_models.designs import Designs
from doe_kc.surrogate_models.influence import Agreement
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.surrogate_models.study import fit_study
from tests.surrogate_models.problems import problem
from tests.surrogate_models.test_selection import space

ENTRIES = tuple(
    CHARACTERISTICS[i] for i in ("vertical.bump_steer", "lateral.toe_change", "static.camber", "static.toe")
)


@cache
def report() -> SurrogateReport:
    """Three outputs of the test problem and one that never changes."""
    p = problem(24)
    y = np.column_stack([p.y, np.full(24, 0.5)])
    fitted = fit_study(p.x, y, models=("linear", "gp"), folds=3, workers=1)
    none = np.full((5, 4), np.nan)
    agreement = Agreement(none[0], none[0], none[0])
    designs = Designs(ENTRIES, p.x, y, 0, 0)
    targets = {"vertical.bump_steer": float(y[:, 0].mean()), "lateral.toe_change": 99.0}
    return SurrogateReport(space(5), designs, fitted, none, none, none, agreement, targets)


def test_one_panel_a_characteristic_with_its_unit_and_model() -> None:
    fig = predicted_against_true(report(), study="small")
    for panel, entry in zip(fig.panels, ENTRIES, strict=True):
        assert entry.label in panel.title.text
        assert f"[{entry.unit}]" in panel.title.text
    assert "gp, Q² 1.0000" in fig.panels[1].title.text
    assert "never changes" in fig.panels[3].title.text
    assert [t.text for t in fig.panels[1].texts if "→" in t.text] == ["99 →"]
    assert fig.outside == []


def test_residuals_have_one_panel_a_characteristic() -> None:
    fig = residuals(report(), study="small")
    for panel, entry in zip(fig.panels, ENTRIES, strict=True):
        assert f"[{entry.unit}]" in panel.title.text
        assert "% inside" in panel.title.text
    assert fig.outside == []


def test_quality_names_models_and_characteristics() -> None:
    fig = model_quality(report(), study="small")
    labels = fig.panels[0].y.ticks(9).words
    assert len(labels) == 4
    assert all(e.label in text for e, text in zip(ENTRIES, labels, strict=True))
    assert fig.keys[0].labels == ["Linear (ridge)", "Gaussian process"]
    assert fig.outside == []


def test_equal_studies_give_equal_files(tmp_path: Path) -> None:
    one = write_surrogate_figures(report(), tmp_path / "a", study="small", workers=1)
    two = write_surrogate_figures(replace(report()), tmp_path / "b", study="small", workers=1)
    assert [p.name for p in one] == [p.name for p in two]
    assert len(one) == 3
    for a, b in zip(one, two, strict=True):
        assert a.read_bytes() == b.read_bytes()
    assert one[0].stat().st_size > 10_000
