"""Which variables to use: verdicts, moves, bounds; closed forms and a known change of the real axle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from doe_kc.axle import parameter_value, with_values
from doe_kc.characteristics import reduce_all
from doe_kc.ground.errors import InputError
from doe_kc.parameter_influence.selection import (
    FIX_FAILED,
    FIX_NO_INFLUENCE,
    USE,
    USE_AT_BOUND,
    per_unit,
    select_variables,
    suggested_bounds,
)
from doe_kc.parameter_influence.selection_result import Selection, VariableAdvice
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests.parameter_influence.studies import parameter, real_study, study
from tests.reference import nominal

BUMP, ROLL = "vertical.bump_steer", "roll.roll_steer"


def by_path(selection: Selection) -> dict[str, VariableAdvice]:
    return {v.parameter.path: v for v in selection.variables}


def test_move_of_one_parameter_in_closed_form() -> None:
    """Slope 3 per mm, sd 0.5, prior sd 2: S = 12; z = S d / (S^2 + 1), move = 2 z."""
    found = select_variables(study([[3.0]]), {BUMP: 4.5}, sd={BUMP: 0.5})
    (v,) = found.variables
    wish = 4.5 / 0.5
    assert v.influence == pytest.approx(12.0)
    assert v.move == pytest.approx(2.0 * 12.0 * wish / 145.0)
    assert v.posterior_ratio == pytest.approx(1.0 / math.sqrt(145.0))
    assert (v.verdict, v.pivot, v.collinearity, v.partner) == (USE, 1, 1.0, "")
    assert found.outcomes[0].expected == pytest.approx(3.0 * v.move)
    assert found.outcomes[0].after == pytest.approx(wish / 145.0)


def test_step_is_divided_out() -> None:
    rows = (parameter("P0.x", step=0.1),)
    assert per_unit(study([[3.0]], parameters=rows))[0, 0] == pytest.approx(30.0)


def test_one_at_a_time_stands_in_for_missing_exact() -> None:
    assert per_unit(study([[3.0]], exact=[[np.nan]]))[0, 0] == pytest.approx(3.0)


def test_default_sd_is_half_the_constraint_interval() -> None:
    found = select_variables(study([[3.0]]), {BUMP: 2.0})
    assert found.outcomes[0].sd == pytest.approx(0.15 * math.sqrt(4.005))


def test_verdicts() -> None:
    change = [[5.0, 0.0], [0.0, 4.0], [2.5, 0.001], [0.001, 0.0], [np.nan, np.nan]]
    found = by_path(select_variables(study(change), {BUMP: 1.0, ROLL: 1.0}, sd={BUMP: 1.0, ROLL: 1.0}))
    assert [v.verdict for v in found.values()] == [
        USE,
        USE,
        "fix (collinear with P0.x)",
        FIX_NO_INFLUENCE,
        FIX_FAILED,
    ]
    assert found["P2.x"].move == 0.0
    assert found["P0.x"].pivot == 1 and found["P1.x"].pivot == 2


def test_move_beyond_the_bound_is_flagged_and_the_bound_widened() -> None:
    found = select_variables(study([[1.0]]), {BUMP: 7.0}, sd={BUMP: 0.1})
    (v,) = found.variables
    assert (v.verdict, v.at_bound) == (USE_AT_BOUND, "upper")
    assert v.move == pytest.approx(4.0)
    wanted = 7.0 * 400.0 / 401.0
    assert v.upper == pytest.approx(1.25 * wanted)
    assert (v.lower, v.widened) == (-4.0, True)
    assert found.outcomes[0].after == pytest.approx(30.0)


@pytest.mark.parametrize(
    ("side", "wanted", "expected"),
    [
        ("", 3.0, (0.5, 2.0)),
        ("upper", 1.5, (0.5, 2.875)),
        ("upper", 99.0, (0.5, 4.0)),
        ("lower", -0.55, (0.3125, 2.0)),
        ("lower", -99.0, (0.25, 2.0)),
    ],
)
def test_stiffness_bounds_stay_positive(side: str, wanted: float, expected: tuple[float, float]) -> None:
    factor = parameter("llr.Fx", group="BUSHINGS", unit="-", nominal=1.0, lower=0.5, upper=2.0, step=0.1)
    assert suggested_bounds(factor, side, wanted) == pytest.approx(expected)


def test_flexibility_is_not_widened_below_zero() -> None:
    rigid = parameter("strut.flexibility", group="OTHER", nominal=0.0, lower=0.0, upper=2.0, step=0.1)
    assert suggested_bounds(rigid, "lower", -5.0) == (0.0, 2.0)


def test_rank_and_condition_of_dependent_columns() -> None:
    found = select_variables(
        study([[4.0, 0.0], [0.0, 1.0], [8.0, 0.0]]), {BUMP: 0.0, ROLL: 0.0}, sd={BUMP: 1.0, ROLL: 1.0}
    )
    assert (found.rank, found.informed) == (2, 2)
    np.testing.assert_allclose(found.singular_values, [2 * math.sqrt(80.0), 2.0])
    assert found.condition == pytest.approx(8.0)


def test_missing_targets_are_left_out() -> None:
    found = select_variables(study([[1.0, 1.0]]), {BUMP: 1.0, ROLL: math.nan})
    assert [o.characteristic for o in found.outcomes] == [BUMP]


@pytest.mark.parametrize(
    ("targets", "sd", "message"),
    [
        ({"vertical.bump_ster": 1.0}, {}, "Did you mean"),
        ({BUMP: math.nan}, {}, "at least one target"),
        ({BUMP: 1.0}, {BUMP: 0.0}, "expected a number > 0"),
    ],
)
def test_bad_input_is_one_sentence(targets: dict[str, float], sd: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        select_variables(study([[1.0]]), targets, sd=sd)


def test_frames_keep_the_order_of_choice() -> None:
    found = select_variables(study([[1.0], [9.0], [0.0]]), {BUMP: 1.0})
    frame = found.to_frame()
    assert frame["parameter"].tolist() == ["P1.x", "P0.x", "P2.x"]
    assert frame["pivot"].isna().tolist() == [False, True, True]
    assert found.outcome_frame()["target"].tolist() == [1.0]


def test_known_change_of_the_real_axle_is_found() -> None:
    """Move four parameters, solve, and select: the moves come back, what was left alone stays."""
    axle = nominal()
    change = {"LLF.z": 1.5, "llr.Fx": 0.15, "RIB.z": -1.0, "arb.radius": 0.3}
    values = {path: parameter_value(axle, path) + delta for path, delta in change.items()}
    targets = reduce_all(curve_set(solve(with_values(axle, values))))
    sd = {name: max(0.01 * abs(value), 1e-4) for name, value in targets.items()}
    found = by_path(select_variables(real_study(), targets, sd=sd))
    for path, delta in change.items():
        assert found[path].used
        assert found[path].move == pytest.approx(delta, rel=0.15), path
    assert abs(found["spring.rate"].move) < 0.1
    assert found["sff.Tz"].verdict == FIX_NO_INFLUENCE
    assert found["arb.radius"].posterior_ratio < 0.05


def test_forecast_of_the_real_axle_reaches_the_target() -> None:
    axle = nominal()
    targets = reduce_all(curve_set(solve(with_values(axle, {"LLF.z": 213.0, "llr.Fx": 1.2}))))
    found = select_variables(real_study(), targets)
    before = math.hypot(*(o.before for o in found.outcomes))
    after = math.hypot(*(o.after for o in found.outcomes))
    assert after < 0.1 * before
