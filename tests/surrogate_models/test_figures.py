"""The figures show every characteristic, in its unit, with nothing cut off."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from openpyxl import load_workbook

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.reports.surrogates.figures import (
    model_quality,
    predicted_against_true,
    residuals,
    write_surrogate_figures,
)
from doe_kc.reports.surrogates.responses import response_surfaces, slices
from doe_kc.reports.surrogates.workbook import write_surrogate_workbook
from doe_kc.surrogate_models.designs import Designs
from doe_kc.surrogate_models.influence import Agreement
from doe_kc.surrogate_models.learning_curve import learning_curve
from doe_kc.surrogate_models.models import make
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


@cache
def report_with_curve() -> SurrogateReport:
    """The same with shares, and a learning curve to a high goal."""
    known = report()
    q2 = known.fitted.of_chosen({k: m.quality.q2 for k, m in known.fitted.models.items()})
    models = {name: make(name) for name in known.fitted.models}
    curve = learning_curve(
        models, known.fitted.chosen, known.fitted.x, known.fitted.y, q2=q2, folds=3, seed=0, workers=1
    )
    shares = np.tile(np.array([0.1, 0.5, 0.0, 0.3, 0.2])[:, None], (1, 4))
    return replace(known, shares=shares, curve=curve, goal=0.9999)


def test_slices_name_the_strongest_variables_first() -> None:
    fig = slices(report_with_curve(), study="small")
    assert [t.text for t in fig.panels[0].texts] == ["p1", "p3", "p4", "p0", "p2"]
    assert f"[{ENTRIES[0].unit}]" in fig.panels[0].title.text
    line = fig.panels[0].lines[0]
    middle = np.full((1, 5), 0.5)
    middle[0, 1] = line.get_xdata()[0]
    wanted = report().fitted.model.predict(middle)[0, 0]
    np.testing.assert_allclose(line.get_ydata()[0], wanted, rtol=1e-9)
    assert fig.outside == []


def test_surfaces_lie_over_the_two_strongest_variables() -> None:
    fig = response_surfaces(report_with_curve(), study="small")
    assert (fig.panels[0].x_label.text, fig.panels[0].y_label.text) == ("p1", "p3")
    values = [float(t.text.replace("−", "-")) for t in fig.panels[0].texts]
    assert len(values) >= 2
    assert fig.panels[3].texts == []
    assert fig.outside == []


def test_the_workbook_has_charts_of_quality_and_designs(tmp_path: Path) -> None:
    path = write_surrogate_workbook(tmp_path / "s.xlsx", report_with_curve(), study="small", date="today")
    book = load_workbook(path)
    assert {"Quality", "Quality chart", "Learning curve", "Designs chart"} <= set(book.sheetnames)
    chart = book["Quality chart"]
    assert len(chart._charts) == 1
    numbers = [
        [c.value for c in row] for row in chart.iter_rows(min_row=5, min_col=24, max_row=9, max_col=27)
    ]
    assert numbers[0][2:] == ["Linear (ridge)", "Gaussian process"]
    gp = report().fitted.models["gp"].quality.q2[0]
    assert abs(numbers[1][3] - 100.0 * np.sqrt(1.0 - gp)) < 1e-9


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
    assert len(one) == 5
    for a, b in zip(one, two, strict=True):
        assert a.read_bytes() == b.read_bytes()
    assert one[0].stat().st_size > 10_000
