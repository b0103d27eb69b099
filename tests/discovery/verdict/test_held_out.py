"""Load cases held out, in absolute terms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from doe_kc.discovery import gauss_newton
from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.gauss_newton import chord_fit, fit
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import HELD_OUT_LIMIT
from doe_kc.discovery.verdict.held_out import HeldOutScore, fit_without, held_out_score, held_out_scores
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import LOAD_CASES, discovery


@pytest.mark.parametrize("car", ["named", "friction"])
def test_a_right_model_predicts_what_it_has_not_seen(car: str) -> None:
    for held in discovery(car).held_out:
        assert -HELD_OUT_LIMIT < held.law_granted.excess < HELD_OUT_LIMIT
        assert held.with_effect.size > 500


def test_a_model_without_the_effect_does_not() -> None:
    assert max(h.tuned.excess for h in discovery("named").held_out) > 3.0 * HELD_OUT_LIMIT


def test_the_excess_counts_records_and_the_noise_s_own_size() -> None:
    assert HeldOutScore(1.23, 0.0, 1300).excess == pytest.approx(8.2, abs=0.1)
    assert HeldOutScore(1.23, 0.0, 10**9).excess == pytest.approx(11.5, abs=0.1)
    assert HeldOutScore(1.1, 0.0, 50).excess == pytest.approx(0.98, abs=0.02)


@pytest.mark.parametrize("case", LOAD_CASES[-1:])
def test_what_a_law_leaves_open_counts_where_it_was_granted(case: str) -> None:
    search = discovery("named").search
    with_effect, law_granted = held_out_scores(search.with_effects, search.with_effects, case)
    assert law_granted is with_effect


def test_a_right_model_is_followed_on_the_derivatives_that_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    search, taken = discovery("named").search, []
    tuning = gauss_newton.own_columns

    def counted(model: EffectModel, *at: FloatArray) -> FloatArray:
        taken.append(model.left_out)
        return tuning(model, *at)

    monkeypatch.setattr(gauss_newton, "own_columns", counted)
    near = fit_without(search.with_effects, "lateral_opposite")
    assert not taken and near.converged
    anew = fit(near.model, search.with_effects.z)
    assert np.linalg.norm((near.z - anew.z) / np.sqrt(np.diag(anew.covariance))) < 0.1
    taken.clear()
    far = fit_without(search.tuned, "steer")
    assert not taken and far.rms > 1.5  # what is far is counted in what remains
    monkeypatch.setattr("doe_kc.discovery.verdict.held_out.CHORD_DECREASE", 0.0)
    exact = fit_without(search.tuned, "steer")
    assert taken and exact.converged
    scores = [held_out_score(search.tuned, other).rms for other in (far, exact)]
    assert scores[0] == pytest.approx(scores[1], rel=0.02)


def test_derivatives_that_lead_nowhere_end_no_fit() -> None:
    with_effects = discovery("named").search.with_effects
    false = replace(with_effects, jacobian=Jacobian(-with_effects.jacobian.dense), z=with_effects.z)
    assert not chord_fit(false, replace(with_effects.model, left_out="steer")).converged


def test_a_linear_model_is_scored_by_the_density_of_its_prediction() -> None:
    whole = discovery("named").search.with_effects
    all_records = _linear_minimum(whole, whole.model)
    others = _linear_minimum(whole, replace(whole.model, left_out="lateral"))
    predicted = np.flatnonzero(~others.model.used)
    residual, rows = others.residual[predicted], others.jacobian.rows(predicted)
    covariance = np.eye(predicted.size) + rows @ others.covariance @ rows.T
    score = held_out_score(all_records, others)
    density = multivariate_normal(np.zeros(predicted.size), covariance).logpdf(residual)
    assert score.score == pytest.approx(density + 0.5 * predicted.size * np.log(2.0 * np.pi), abs=1e-5)
    square = float(residual @ np.linalg.solve(covariance, residual))
    assert score.rms == pytest.approx(np.sqrt(square / predicted.size), rel=1e-8)


def _linear_minimum(near: Fit, model: EffectModel) -> Fit:
    """Of the model linearized at a fit, without bounds."""
    start = replace(near, model=model)
    step = -np.linalg.solve(start.hessian, start.gradient)
    z, residual = near.z + step, near.residual + near.jacobian.moved(step)
    return replace(start, z=z, residual=residual, cost=cost_of(model, z, residual))
