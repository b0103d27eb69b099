"""The first-order step: on the levels, inside the bounds, and better than where it starts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.correlation.methods.ego.method import first_order
from doe_kc.correlation.problem import Candidate
from doe_kc.true_solver.outcome import failure
from tests.correlation.cases import outcome, problem
from tests.correlation.synthetic import answer, synthetic


def test_it_leads_from_the_baseline_to_a_far_better_axle() -> None:
    case = problem("car_b")
    start = Candidate(case.space.start, "baseline")
    before = case.judged(0, start, outcome(case.axle, case.space.values(start.point)))
    step = first_order(case, before)
    assert step is not None
    assert np.array_equal(step.point, case.space.snapped(step.point))
    assert (step.point >= 0.0).all() and (step.point <= 1.0).all()
    after = case.judged(1, step, outcome(case.axle, case.space.values(step.point)))
    assert after.merit > 0.01 * before.merit  # a hundredth of the penalty is left at most


def test_without_data_or_after_a_failure_there_is_none() -> None:
    case = synthetic(12)
    start = Candidate(case.space.start, "baseline")
    before = case.judged(0, start, answer(case, start.point))
    assert first_order(replace(case, likelihood=Likelihood((), ())), before) is None
    assert first_order(case, case.judged(0, start, failure("no equilibrium"))) is None
