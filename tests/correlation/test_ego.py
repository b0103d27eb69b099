"""Composite efficient global optimization: its parts, and a real car with exact slopes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.least_squares import Prior
from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import METHODS, MethodSettings
from doe_kc.correlation.methods.ego.proposer import (
    RELEVANCE_FROM,
    RELEVANCE_TO,
    ExpectedImprovement,
    outputs_model,
)
from doe_kc.correlation.methods.ego.strategy import (
    EGO_PATIENCE,
    PROPOSAL_CYCLE,
    RESTARTS,
    Strategy,
    VarianceCalibration,
)
from doe_kc.correlation.modelled.archive import build_archive
from doe_kc.correlation.modelled.proposal import fit_outputs, gauss_newton
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.correlation.options import Gradients
from doe_kc.correlation.problem import Candidate, Evaluated, RatingForecast
from doe_kc.surrogate_models.models.gp import GaussianProcess
from doe_kc.surrogate_models.models.gp_ard import RelevanceProcess
from doe_kc.surrogate_models.varying import fit_varying
from doe_kc.targets import Score, improvements, mean_improvement
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import VariableOptions
from tests.correlation.cases import problem, solver
from tests.correlation.synthetic import Synthetic, synthetic
from tests.correlation.synthetic import solver as synthetic_solver
from tests.correlation.test_composite import designs


def test_expected_improvement_has_exact_slopes() -> None:
    archive = build_archive(problem("car_b").targets, designs())
    model = GaussianProcess().fit(archive.points, archive.outputs)
    failed = archive.points[:1] + 0.03
    search = ExpectedImprovement(model, archive.composite, archive.best.merit, failed, seed=1)
    rng = np.random.default_rng(2)
    point = archive.best.point + rng.uniform(-0.02, 0.02, archive.best.point.size)
    _, found = search.log(point)
    for i in rng.choice(point.size, 12, replace=False):
        h = 1e-6
        up, down = point.copy(), point.copy()
        up[i] += h
        down[i] -= h
        known = (search.log(up)[0] - search.log(down)[0]) / (2.0 * h)
        assert found[i] == pytest.approx(known, rel=1e-3, abs=1e-4 * np.abs(found).max())


@pytest.mark.parametrize(
    ("rows", "slopes", "scales_each"),
    [
        (RELEVANCE_FROM - 1, False, False),
        (RELEVANCE_FROM, False, True),
        (RELEVANCE_FROM, True, False),
        (RELEVANCE_TO + 1, False, False),
    ],
    ids=["few", "enough", "with slopes", "too many"],
)
def test_outputs_have_length_scales_of_their_own_where_values_alone_can_tell_them(
    rows: int, slopes: bool, scales_each: bool
) -> None:
    rng = np.random.default_rng(7)
    points = rng.uniform(0.4, 0.6, (rows, 3))
    outputs = np.sin(4.0 * points @ rng.standard_normal((3, 2)))
    given = replace(
        build_archive(problem("car_b").targets, designs()), points=points, outputs=outputs, expansion=None
    )
    if slopes:
        solved = replace(given.best, candidate=Candidate(points[0], "start"))
        given = replace(given, solved=(solved,), expansion=np.ones((2, 3)))
    model = RelevanceProcess() if scales_each else None
    expected = fit_outputs(given) if model is None else fit_varying(model, points, outputs, seed=0)
    other = fit_outputs(given) if scales_each else fit_varying(RelevanceProcess(), points, outputs, seed=0)
    near = rng.uniform(0.4, 0.6, (4, 3))
    np.testing.assert_array_equal(outputs_model(given).predict(near), expected.predict(near))
    assert np.abs(other.predict(near) - expected.predict(near)).max() > 1e-6


def test_gauss_newton_raises_the_expected_rating_and_stays_in_its_box() -> None:
    case = problem("car_b")
    archive = build_archive(case.targets, designs())
    model = GaussianProcess().fit(archive.points, archive.outputs)
    start = archive.best.point
    box = TrustBox.around(start, 0.05)
    found = gauss_newton(model, archive.composite, box, start, Prior.of(start, case.space.prior_sd))

    def expected(x: np.ndarray) -> float:
        return float(archive.composite.expected(model.predict(x[None]), model.variance(x[None])[0])[0])

    assert expected(found) > expected(start)
    assert np.all((found >= box.lower) & (found <= box.upper))


def test_strategy_keeps_what_gains_and_turns_from_what_does_not() -> None:
    first = Strategy()
    bolder = first.after(gain=10.0, best=-100.0)
    assert bolder.kind == "Gauss-Newton" and bolder.aversion < first.aversion
    other = bolder.after(gain=0.0, best=-90.0)
    assert other.kind == PROPOSAL_CYCLE[1] and other.aversion > bolder.aversion and other.idle == 1


def test_strategy_restarts_elsewhere_and_ends() -> None:
    state, restarts = Strategy(), 0
    for _ in range((RESTARTS + 1) * (EGO_PATIENCE + 1)):
        if state.stopped:
            break
        state = state.after(gain=0.0, best=-1.0)
        restarts += state.kind == "restart"
    assert restarts == RESTARTS and "gained less than" in state.stopped


def answer(error: float, sd: float) -> Evaluated:
    predicted = RatingForecast(np.zeros(4), np.full(4, sd), 0.0, 0.0)
    return Evaluated(
        1, Candidate(np.zeros(2), "x", predicted), Outcome(None, np.zeros(30), "", 0.0),
        Score(np.full(4, error), np.zeros(0)), None, None, 0.0, np.zeros(0),
    )  # fmt: skip


def test_trust_follows_the_errors_seen() -> None:
    trust = VarianceCalibration()
    for _ in range(8):
        sd = 0.1 * np.sqrt(trust.factor)  # what a method states carries the factor
        trust.learn([answer(0.2, float(sd))])
    assert trust.factor == pytest.approx(4.0, rel=1e-6)


def test_outputs_predicted_with_certainty_say_nothing_of_the_others() -> None:
    trust, seen = VarianceCalibration(), answer(0.2, 0.1)
    predicted = seen.candidate.predicted
    assert predicted is not None
    some = replace(predicted, sd=np.array([0.0, 0.1, 0.1, 0.0]))
    trust.learn([replace(seen, candidate=replace(seen.candidate, predicted=some))])
    assert trust.factor == pytest.approx(2.0)  # geometric mean of 1 and 4
    none = replace(predicted, sd=np.zeros(4))
    trust.learn([replace(seen, candidate=replace(seen.candidate, predicted=none))])
    assert trust.factor == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("exact", "gradients", "slopes"),
    [(True, "auto", True), (True, True, True), (True, False, False), (False, "auto", False)],
)
def test_learns_slopes_where_the_solver_gives_them(
    exact: bool, gradients: Gradients, slopes: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[np.ndarray] = []
    known = Synthetic.linearize

    def watched(self: Synthetic, point: np.ndarray) -> Linearization:
        asked.append(point)
        return known(self, point)

    monkeypatch.setattr(Synthetic, "linearize", watched)
    case = replace(synthetic(12), exact=exact)
    method = METHODS["ego"](case, MethodSettings(seed=1, budget=12, gradients=gradients))
    run = run_method(case, method, synthetic_solver(case), budget=12)
    opening = sum(e.candidate.origin == "opening sample" for e in run.evaluated)
    assert opening == (1 if slopes else 8)
    assert [e.candidate.origin for e in run.evaluated].count("first-order step") == slopes
    bests = {
        e.point.tobytes()
        for i, e in enumerate(run.evaluated)
        if e.merit == max(o.merit for o in run.evaluated[: i + 1])
    }
    assert bool(asked) == slopes
    later = asked[1:]  # the first is of the step from the baseline
    assert len({p.tobytes() for p in later}) == len(later) and {p.tobytes() for p in asked} <= bests


def test_with_exact_slopes_a_settled_search_ends() -> None:
    case = replace(synthetic(12), exact=True)
    run = run_method(
        case, METHODS["ego"](case, MethodSettings(seed=1, budget=80)), synthetic_solver(case), budget=80
    )
    assert run.stopped and len(run.evaluated) < 40
    assert {"random", "restart"}.isdisjoint(e.candidate.origin for e in run.evaluated)


@pytest.mark.parametrize("gradients", ["auto", False])
def test_outputs_that_no_variable_moves_are_no_hindrance(gradients: Gradients) -> None:
    case = problem("car_b", VariableOptions(use=["arb.radius", "tyre.rate", "scb.Tz"]))
    method = METHODS["ego"](case, MethodSettings(seed=1, budget=8, first=4, gradients=gradients))
    run = run_method(case, method, solver(case.axle), budget=8)
    assert len(run.evaluated) == 8 and run.best != 0


def test_with_exact_slopes_a_car_is_correlated_in_a_dozen_runs() -> None:
    case = problem("car_b")
    method = METHODS["ego"](case, MethodSettings(seed=1, budget=12))
    run = run_method(case, method, solver(case.axle), budget=12)
    best = run.evaluated[run.best]
    assert best.rating is not None and best.rating.feasible
    before, after = run.evaluated[0].score, best.score
    assert before is not None and after is not None
    assert mean_improvement(improvements(case.targets, before, after)) > 95.0
