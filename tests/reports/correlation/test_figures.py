"""Pictures of a correlation: all written, nothing off the axis, everything labelled."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.ground.errors import RunError
from doe_kc.ground.numbers import short
from doe_kc.reports.correlation.convergence import convergence_figure
from doe_kc.reports.correlation.curves import case_views, curve_figure
from doe_kc.reports.correlation.dna import DNA_REACH, dna_figure
from doe_kc.reports.correlation.figures import parameter_figure, write_correlation_figures
from doe_kc.reports.drawing.panel import Panel
from tests.correlation.cases import measured
from tests.reports.correlations import CAR, all_three, odd, real, typed


def texts(panel: Panel) -> list[str]:
    return [t.text for t in panel.texts]


def test_files_are_written_without_curves_too(tmp_path: Path) -> None:
    paths = write_correlation_figures(
        typed(), None, tmp_path / "new", study="S $x_1$", workers=1, pictures="svg"
    )
    names = ["correlation_dna", "correlation_parameters", "correlation_axle", "correlation_convergence"]
    assert [p.name for p in paths] == [f"{n}.svg" for n in names]
    assert all(p.stat().st_size > 5000 for p in paths)


@pytest.mark.parametrize("name", ["real", "odd", "typed"])
def test_dna_keeps_every_mark_on_the_axis(name: str) -> None:
    found = all_three()[name]
    page = dna_figure(found, "S")
    (panel,) = page.panels
    assert page.outside == []
    places = np.concatenate([np.atleast_1d(line.get_xdata()) for line in panel.lines]).astype(float)
    assert (np.abs(places - 1.0) <= DNA_REACH + 1e-12).all()
    words = texts(panel)
    for entry in found.improvements:
        assert entry.target.entry.label in words and short(entry.final) in words


def test_values_beyond_the_axis_are_arrows() -> None:
    marks = [str(line.get_marker()) for line in dna_figure(real(), "S").panels[0].lines]
    assert marks.count("<") == 2 and marks.count(">") == 1


def test_curves_have_units_and_both_wheels() -> None:
    (view,) = [v for v in case_views(real(), measured(CAR)) if v.load_case == "roll"]
    page = curve_figure(view, "S")
    assert [panel.y_label.text for panel in page.panels][:2] == ["Δ toe [deg]", "Δ camber [deg]"]
    assert all(panel.x_label.text.endswith("[deg]") for panel in page.panels[-3:])
    assert page.outside == []
    toe = page.panels[0]
    blue = [line for line in toe.lines if line.get_color() == "#0072B2"]
    assert len(blue) == 2 and blue[0].get_lw() < blue[1].get_lw()
    case = real().best.outcome.curves
    assert case is not None
    np.testing.assert_array_equal(blue[1].get_ydata(), case.cases["roll"].mean["toe"][0])


def test_without_measurement_the_model_is_drawn_alone() -> None:
    views = case_views(real(), None)
    assert len(views) == 8 and all(v.measured is None for v in views)
    assert len(curve_figure(views[0], "S").panels[0].lines) == 4
    assert case_views(typed(), None) == []


def test_convergence_shows_failures_predictions_and_feasibility() -> None:
    def labels(name: str) -> list[str]:
        page = convergence_figure(all_three()[name], "S")
        assert page.outside == []
        return page.keys[0].labels

    assert {"no equilibrium", "predicted ± sd", "ego, infeasible", "best so far"} <= set(labels("odd"))
    assert "feasible from evaluation 2" in labels("real")
    crosses = [x for x in convergence_figure(odd(), "S").panels[0].lines if x.get_marker() == "x"]
    assert list(np.atleast_1d(crosses[0].get_xdata())) == [3.0, 7.0]


def test_parameters_mark_bounds_and_unseen_ones() -> None:
    (panel,) = parameter_figure(odd(), "S").panels
    marks = [str(line.get_marker()) for line in panel.lines]
    assert (marks.count("<"), marks.count(">")) == (1, 1)
    assert sum(bool(p.get_hatch()) for p in panel.areas) == 1
    assert len(parameter_figure(real(), "S").panels) == 2


def test_unwritable_folder_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    with pytest.raises(RunError, match="out"):
        write_correlation_figures(typed(), None, tmp_path / "out", study="S", workers=1)
