"""The learning curve: a known power law, what it asks for, and what it does with too few designs."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.reports.surrogates.learning import learning_curves, learning_document, learning_lines
from doe_kc.surrogate_models.learning_curve import LearningCurve, learning_curve
from doe_kc.surrogate_models.models import make
from tests.surrogate_models.problems import outputs, points, problem
from tests.surrogate_models.test_figures import report_with_curve

P = problem()


def test_a_power_law_is_followed_to_the_goal() -> None:
    """e = 2 / N: Q2 of 0.9996 (e = 0.02) at 100 designs, of 0.9999 at 200."""
    curve = LearningCurve((20.0, 40.0), np.array([[0.1], [0.05]]), np.array([1.0]), 0.0)
    assert curve.error(80.0) == pytest.approx([0.025])
    best, low, high = curve.needed(0.9996)
    assert best == pytest.approx([100.0])
    assert curve.needed(0.9999)[0] == pytest.approx([200.0])
    assert low[0] < 100.0 < high[0]
    assert low[0] * high[0] == pytest.approx(100.0**2)


def test_what_is_beyond_reach_is_cut() -> None:
    curve = LearningCurve((20.0, 40.0), np.array([[0.1, 0.9], [0.05, 0.8]]), np.array([1.0, 0.25]), 0.3)
    best, low, high = curve.needed(0.98)
    assert best == pytest.approx([20.0, 800.0])
    assert low[0] == 20.0
    assert high[1] == pytest.approx(800.0)


def test_errors_of_half_the_designs_are_those_of_a_fit_to_them() -> None:
    """A linear model of a noisy plane, whose error needs no more than a few rows."""
    rng = np.random.default_rng(4)
    x = points(80, 9)
    y = (x @ np.arange(1.0, 6.0))[:, None] + 0.1 * rng.standard_normal((80, 1))
    linear = {"linear": make("linear")}
    curve = learning_curve(linear, ["linear"], x, y, q2=np.array([0.99]), folds=10, seed=1, workers=1)
    assert curve is not None
    assert curve.sizes == (40.0, 72.0)
    assert curve.errors[0] == pytest.approx([0.1 / y.std()], rel=0.3)
    assert curve.errors[1] == pytest.approx([0.1])


def test_the_curve_foretells_the_error_of_more_designs() -> None:
    """60 designs of the test problem from 30, on 300 separate points."""
    x, many = points(30, 12), points(60, 13)
    gp, test = make("gp"), points(300, 60)
    y = outputs(x)

    def missed(rows: np.ndarray) -> np.ndarray:
        error = gp.fit(rows, outputs(rows)).predict(test) - outputs(test)
        return np.asarray(np.sqrt((error**2).mean(axis=0)) / outputs(test).std(axis=0))

    q2 = 1.0 - missed(x) ** 2
    curve = learning_curve({"gp": gp}, ["gp"] * 3, x, y, q2=q2, folds=30, seed=0, workers=1)
    assert curve is not None
    assert np.exp(np.abs(np.log(curve.error(60.0) / missed(many)))).max() < 4.0


def test_too_few_designs_have_none() -> None:
    x = points(4, 3)
    assert (
        learning_curve(
            {"gp": make("gp")}, ["gp"] * 3, x, outputs(x), q2=np.full(3, 0.5), folds=3, seed=0, workers=1
        )
        is None
    )


def test_it_is_drawn_listed_and_told() -> None:
    report = report_with_curve()
    assert report.curve is not None
    fig = learning_curves(report, report.curve, study="small")
    assert "never changes" in fig.panels[3].title.text
    assert fig.outside == []
    document = learning_document(report)
    assert document["static.toe"]["designs"] is None
    assert learning_lines(report)[0].startswith("Q2 of 0.9999: ")
