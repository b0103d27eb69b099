"""Loop widths: the mean over the inner half of a sweep, their noise, and the picture of all loops."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.curves import RIG_RESPONSES, CaseCurves
from doe_kc.reports.correlation.curves import CaseView, case_views, curve_figure, has_loop
from doe_kc.reports.hysteresis import hysteresis_figure, hysteresis_table, inner_mean, loop_widths
from doe_kc.reports.render.csv import table_frame
from tests.correlation.cases import measured
from tests.reports.correlations import CAR, real


def looped(case: CaseCurves, width: float) -> CaseCurves:
    """A rectangular loop in every response of the left wheel, none of the right."""
    half = np.stack([np.full(case.input.size, width), np.zeros(case.input.size)])
    return replace(case, half_width=dict.fromkeys(case.half_width, half))


@pytest.fixture
def view() -> CaseView:
    """Roll, with a final model that has friction."""
    (plain,) = [v for v in case_views(real(), measured(CAR)) if v.load_case == "roll"]
    assert plain.final is not None
    return replace(plain, final=looped(plain.final, 0.25))


def test_the_mean_is_that_of_the_inner_half() -> None:
    inputs = np.linspace(-2.0, 2.0, 9)
    half = np.where(np.abs(inputs) <= 1.0, 3.0, 50.0)
    case = CaseCurves("roll", "deg", inputs, {}, {"toe": np.stack([half, -half])})
    assert [inner_mean(case, "toe", side) for side in (0, 1)] == pytest.approx([3.0, -3.0])
    assert np.isnan(inner_mean(case, "camber", 0)) and np.isnan(inner_mean(None, "toe", 0))


def test_a_row_a_case_response_and_wheel_with_the_noise_of_the_records() -> None:
    records = measured(CAR)
    rows = loop_widths(real(), records)
    assert len(rows) == len(records.curves.cases) * len(RIG_RESPONSES) * 2
    assert all(row.sd > 0 and np.isfinite(row.measured) for row in rows)
    assert all(row.final == row.baseline == 0.0 for row in rows)  # neither has friction
    # noise alone: about one in twenty is beyond two standard deviations
    assert np.mean([row.visible for row in rows]) < 0.25
    frame = table_frame(hysteresis_table(rows))
    assert list(frame.columns[:3]) == ["load_case", "response", "side"] and len(frame) == len(rows)


def test_only_a_model_with_friction_has_its_loop_drawn(view: CaseView) -> None:
    assert view.final is not None and view.baseline is not None
    assert has_loop(view.final, "toe") and not has_loop(view.baseline, "toe")
    page = hysteresis_figure([view], "S $x_1$")
    assert page.outside == [] and page.heading.endswith("S $x_1$")
    labels = page.keys[0].labels
    assert "final, left wheel" in labels and "baseline, left wheel" not in labels
    toe = page.panels[0]
    blue = [line for line in toe.lines if line.get_color() == "#0072B2"]
    assert [set(np.asarray(line.get_ydata())) for line in blue] == [{0.0}, {0.25}]
    assert any(text.text.endswith(" / 0.25000") for text in toe.texts)


def test_curves_show_both_branches_of_such_a_model(view: CaseView) -> None:
    page = curve_figure(view, "S")
    assert len(page.panels) == len(RIG_RESPONSES)
    assert [p.y_label.text for p in page.panels][5] == "Δ wheel centre z [mm]"
    dotted = [line for line in page.panels[0].lines if line.get_linestyle() == ":"]
    assert len(dotted) == 4
    assert "   its branches, with friction" in page.keys[0].labels
