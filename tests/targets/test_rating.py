"""Equation 2.2 against hand calculation, and its parts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.targets import Constraint, CurveTarget, Objective, Score, Target, Targets, rate
from doe_kc.targets.improvement import exact_model_improvement, improvements, mean_improvement

A, B, C = list(CHARACTERISTICS.values())[:3]


def curve(linear: float = 1.0, quadratic: float = 0.0, norm: float = 2.0) -> CurveTarget:
    return CurveTarget(
        load_case="vertical", response="toe", input_unit="mm", input=np.array([-1.0, 1.0]),
        curve=np.zeros((2, 2)), noise=0.0,
        objective=Objective(linear=linear, quadratic=quadratic, norm=norm),
    )  # fmt: skip


def target(entry=A, value: float = 2.0, sd: float = 0.1, **roles) -> Target:  # type: ignore[no-untyped-def]
    return Target(entry=entry, value=value, sd=sd, **roles)


def test_every_term_of_the_equation() -> None:
    targets = Targets(
        (
            target(A, 2.0, objective=Objective(linear=3.0, quadratic=5.0, norm=4.0)),
            target(B, 1.0, constraint=Constraint(low=0.9, high=1.1, linear=7.0, quadratic=11.0, norm=0.5)),
            target(C, 0.0, objective=Objective(goal="maximize", linear=2.0, quadratic=0.5, norm=10.0)),
        ),
        (curve(linear=1.5, quadratic=2.5),),
        "hand",
    )
    found = rate(targets, Score(np.array([1.0, 1.6, 4.0]), np.array([3.0])))
    first = -(3.0 * 1.0 / 4.0 + 5.0 * 1.0 / 16.0)
    second = -(7.0 * 0.5 / 0.5 + 11.0 * 0.25 / 0.25)
    third = 2.0 * 4.0 / 10.0 + 0.5 * 16.0 / 100.0
    fourth = -(1.5 * 3.0 / 2.0 + 2.5 * 9.0 / 4.0)
    assert found.total == pytest.approx(first + second + third + fourth)
    assert not found.feasible
    np.testing.assert_allclose(found.violation, [0.0, 0.5, 0.0])


def test_defaults_give_equation_2_3() -> None:
    entry = target(objective=Objective(norm=2.0), constraint=Constraint(low=1.7, high=2.3, norm=2.0))
    found = rate(Targets((entry,), (), "hand"), Score(np.array([2.5]), np.zeros(0)))
    assert found.total == pytest.approx(-0.5 / 2.0 - 10000.0 * (0.2 / 2.0) ** 2)


def test_zero_at_the_optimum() -> None:
    entry = target(objective=Objective(norm=2.0), constraint=Constraint(low=1.7, high=2.3, norm=2.0))
    found = rate(Targets((entry,), (curve(),), "hand"), Score(np.array([2.0]), np.array([0.0])))
    assert found.total == 0.0 and found.feasible


@given(value=st.floats(-10.0, 10.0))
def test_only_violations_make_infeasible(value: float) -> None:
    entry = target(constraint=Constraint(low=1.5, high=2.5))
    found = rate(Targets((entry,), (), "hand"), Score(np.array([value]), np.zeros(0)))
    assert found.feasible == (1.5 <= value <= 2.5)


def test_improvement_counts_beyond_three_deviations_of_the_target() -> None:
    entries = (
        target(A, 1.0, 0.1, objective=Objective()),
        target(B, 1.0, 0.1, objective=Objective()),
        target(C, 1.0, 0.1),
    )
    targets = Targets(entries, (), "hand")
    found = improvements(
        targets,
        Score(np.array([2.0, 1.29, 2.0]), np.zeros(0)),
        Score(np.array([1.1, 1.29, 2.0]), np.zeros(0)),
    )
    assert [f.counts for f in found] == [True, False, False]
    assert found[0].percent == pytest.approx(90.0)
    assert mean_improvement(found) == pytest.approx(90.0)


def test_improvement_of_an_exact_model_is_what_the_noise_of_the_targets_leaves() -> None:
    sd, truth, baseline, generator = 0.1, 1.0, 1.5, np.random.default_rng(5)
    shown = []
    for value in truth + sd * generator.standard_normal(20_000):
        entries = (target(A, float(value), sd, objective=Objective()),)
        before, after = (Score(np.array([x]), np.zeros(0)) for x in (baseline, truth))
        shown.append(mean_improvement(improvements(Targets(entries, (), "hand"), before, after)))
    entries = (target(A, truth, sd, objective=Objective()),)
    score = Score(np.array([baseline]), np.zeros(0))
    expected = exact_model_improvement(improvements(Targets(entries, (), "hand"), score, score))
    assert expected == pytest.approx(100.0 - 100.0 * np.sqrt(2.0 / np.pi) * sd / 0.5)
    assert np.nanmean(shown) == pytest.approx(expected, abs=1.5)


def test_improvement_of_a_baseline_on_target_is_no_number() -> None:
    targets = Targets((target(A, 1.0, 0.0, objective=Objective()),), (), "hand")
    score = Score(np.array([1.0]), np.zeros(0))
    (found,) = improvements(targets, score, score)
    assert np.isnan(found.percent) and not found.counts
    assert np.isnan(mean_improvement([found]))


def test_appendix_d_improvements() -> None:
    """The thesis's own table: 0 % = baseline, 100 % = target. Printed with rounded values, so to 5 %."""
    import pandas as pd

    from tests.targets import APPENDIX_D

    table = pd.read_csv(APPENDIX_D)
    slips = (table.load_case == "Drive force") & (table.characteristic == "Load transfer")
    slips |= (table.load_case == "Lat. force") & (table.characteristic == "Track variation")
    for row in table[~slips].itertuples():
        entry = target(A, float(row.target), 0.0, objective=Objective())
        (found,) = improvements(
            Targets((entry,), (), "thesis"),
            Score(np.array([float(row.baseline)]), np.zeros(0)),
            Score(np.array([float(row.final)]), np.zeros(0)),
        )
        assert found.percent == pytest.approx(row.improvement_percent, abs=5.0), row
