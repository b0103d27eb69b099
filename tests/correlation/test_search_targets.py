"""What a search works on, and what it must leave where it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.reach import Relaxation
from doe_kc.correlation.search_targets import (
    all_measured,
    hold_distance,
    misfit_term,
    relaxed_places,
    search_targets,
)
from doe_kc.targets import CharacteristicOptions, Score, Targets, build_targets, score
from doe_kc.targets.comparison import constraint_interval
from doe_kc.targets.options import CurveOptions
from doe_kc.true_solver.outcome import Outcome
from tests.correlation.cases import AXLE, measured, outcome, problem

ROLL_RATE = "roll.roll_rate"
"""Passive in the thesis: neither objective nor constraint."""
CAMBER = "lateral.camber_change"


@pytest.fixture(scope="module")
def start() -> Outcome:
    case = problem("car_b")
    return outcome(case.axle, case.space.values(case.space.start))


def targets(*options: CharacteristicOptions, curves: tuple[CurveOptions, ...] = ()) -> Targets:
    from doe_kc.axle_file import read_axle

    return build_targets(read_axle(AXLE), measured("car_b"), options, curves, source="test")


def baseline(of: Targets, start: Outcome) -> Score:
    return score(all_measured(of), start.characteristics, start.curves)


def of(found: Targets, ident: str):  # type: ignore[no-untyped-def]
    return next(t for t in found.characteristics if t.entry.id == ident)


def test_everything_measured_counts_by_default_and_the_ratings_terms_alone_for_the_thesis(
    start: Outcome,
) -> None:
    plain = targets()
    measured_ = search_targets(plain, baseline(plain, start), objective="measured")
    thesis = search_targets(plain, baseline(plain, start), objective="thesis")
    assert of(plain, ROLL_RATE).objective is None
    assert of(measured_, ROLL_RATE).objective is not None and of(thesis, ROLL_RATE).objective is None
    assert all(t.objective is not None for t in measured_.characteristics)
    assert len(measured_.curves) == len(plain.curves) + len(plain.others) == len(thesis.curves)
    counted = [c.id for c in thesis.curves if c.objective.linear]
    assert counted == [c.id for c in plain.curves]
    assert all(c.objective.linear for c in measured_.curves)
    for one, other in zip(plain.characteristics, thesis.characteristics, strict=True):
        assert one.objective == other.objective and one.constraint == other.constraint


def test_nothing_may_move_further_than_interval_noise_and_baseline_allow(start: Outcome) -> None:
    plain = targets()
    before = baseline(plain, start)
    found = search_targets(plain, before, objective="measured")
    for t, value in zip(found.characteristics, before.values, strict=True):
        low, high = constraint_interval(t.value)
        expected = max((high - low) / 2.0, 3.0 * t.sd, abs(value - t.value))
        assert t.limit == pytest.approx(expected, rel=1e-5) and t.limit > expected
    for curve, rms in zip(found.curves, before.rms, strict=True):
        assert curve.limit > rms and curve.limit >= 3.0 * curve.noise


def test_what_is_not_worked_on_stays_nearer_than_its_interval(start: Outcome) -> None:
    plain = targets(CharacteristicOptions(match=ROLL_RATE, objective=False))
    before = baseline(plain, start)
    held = of(search_targets(plain, before, objective="measured"), ROLL_RATE)
    value = float(before.values[[t.entry.id for t in plain.characteristics].index(ROLL_RATE)])
    assert held.objective is None and held.constraint is None
    expected = max(abs(value - held.value), 3.0 * held.sd, 0.02 * held.scale)
    assert held.limit == pytest.approx(expected, rel=1e-5)
    assert held.limit < 0.5 * hold_distance(held, value)


def test_a_study_lets_go(start: Outcome) -> None:
    free = (CurveOptions(match="roll.tyre_load", hold=False),)
    plain = targets(CharacteristicOptions(match=ROLL_RATE, objective=False, hold=False), curves=free)
    found = search_targets(plain, baseline(plain, start), objective="measured")
    assert of(found, ROLL_RATE).limit == np.inf
    (curve,) = [c for c in found.curves if c.id == "roll.tyre_load"]
    assert curve.limit == np.inf


def test_what_the_study_switches_off_is_no_objective_but_held(start: Outcome) -> None:
    plain = targets(CharacteristicOptions(match=CAMBER, objective=False, constraint=False))
    found = search_targets(plain, baseline(plain, start), objective="measured")
    assert of(found, CAMBER).objective is None and np.isfinite(of(found, CAMBER).limit)
    (curve,) = [c for c in found.curves if c.id == "lateral.camber"]
    assert curve.objective.linear == 0.0 and np.isfinite(curve.limit)


def test_a_target_out_of_reach_is_no_objective_and_its_interval_is_wider(start: Outcome) -> None:
    plain = targets()
    wide = Relaxation({CAMBER: 0.5}, {CAMBER: ("upb.Fy",)})
    found = search_targets(plain, baseline(plain, start), objective="measured", relaxation=wide)
    relaxed, before = of(found, CAMBER), of(plain, CAMBER)
    assert relaxed.objective is None and relaxed.constraint is not None and before.constraint is not None
    assert relaxed.constraint.low == pytest.approx(before.value - 0.5)
    assert relaxed.constraint.high == pytest.approx(before.value + 0.5)
    (curve,) = [c for c in found.curves if c.id == "lateral.camber"]
    assert curve.objective.linear == 0.0
    assert relaxed_places(plain, wide) == {("lateral", "camber")}


def test_the_baseline_meets_every_limit_and_a_worse_design_does_not(start: Outcome) -> None:
    plain = problem("car_b")
    before = baseline(plain.targets, start)
    sought = search_targets(plain.targets, before, objective="measured")
    case = replace(plain, sought=sought)
    from doe_kc.correlation.problem import Candidate

    judged = case.judged(0, Candidate(case.space.start, "baseline"), start)
    assert judged.harmless
    worse = start.characteristics.copy()
    place = int(case.targets.rows[[t.entry.id for t in sought.characteristics].index(ROLL_RATE)])
    worse[place] *= 1.3
    harmed = case.judged(1, Candidate(case.space.start, "x"), replace(start, characteristics=worse))
    assert not harmed.harmless and harmed.merit < judged.merit - 100.0


def test_the_misfit_is_tempered_by_what_no_design_explains(start: Outcome) -> None:
    case = problem("car_b")
    expansion = case.linearize(case.space.start)
    term = misfit_term(case.likelihood, case.space, start, expansion)
    assert term is not None and term.size == case.likelihood.size
    assert 0.5 < term.weight <= 2.0  # re-tuning explains this car, so noise is all that is left
    curve = case.likelihood.curves[0]
    odd = replace(curve, value=curve.value + 1e3 * curve.level * np.resize([1.0, -1.0], curve.size))
    wild = replace(case.likelihood, curves=(odd, *case.likelihood.curves[1:]))
    other = misfit_term(wild, case.space, start, expansion)
    assert other is not None and other.weight < 0.01 * term.weight


def test_a_default_interval_narrower_than_the_noise_is_widened_a_stated_one_is_not(start: Outcome) -> None:
    noisy = CharacteristicOptions(match=CAMBER, sd=1.0)
    stated = CharacteristicOptions(match=CAMBER, sd=1.0, low=0.0, high=0.5)
    for option, low, high in ((noisy, -3.0, 3.0), (stated, 0.0, 0.5)):
        plain = targets(option)
        value = of(plain, CAMBER).value
        measured_ = of(search_targets(plain, baseline(plain, start), objective="measured"), CAMBER).constraint
        thesis = of(search_targets(plain, baseline(plain, start), objective="thesis"), CAMBER).constraint
        shift = value if option is noisy else 0.0
        assert (measured_.low, measured_.high) == pytest.approx((shift + low, shift + high))
        assert (thesis.low, thesis.high) == (
            of(plain, CAMBER).constraint.low,
            of(plain, CAMBER).constraint.high,
        )
