"""Targets from records, typed in, or both."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.ground.files import validate
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.targets import CharacteristicOptions, CurveOptions, Targets, build_targets, score
from doe_kc.targets.comparison import constraint_interval, rms_deviation
from tests.correlation.cases import measured
from tests.reference import nominal


def targets(
    characteristics: list[dict[str, Any]] | None = None,
    curves: list[dict[str, Any]] | None = None,
    *,
    records: bool = True,
) -> Targets:
    return build_targets(
        nominal(),
        measured("car_b") if records else None,
        [validate(CharacteristicOptions, c, "study") for c in characteristics or []],
        [validate(CurveOptions, c, "study") for c in curves or []],
        source="study",
    )


def test_defaults_are_appendix_b_and_equations_5_1_and_5_2() -> None:
    found = targets()
    for t in found.characteristics:
        assert (t.objective is not None) == t.entry.objective
        assert (t.constraint is not None) == t.entry.constraint
        if t.constraint is not None:
            assert (t.constraint.low, t.constraint.high) == constraint_interval(t.value)
            assert (t.constraint.linear, t.constraint.quadratic) == (0.0, 10000.0)
        if t.objective is not None:
            assert (t.objective.linear, t.objective.quadratic) == (1.0, 0.0)
            assert t.objective.norm == pytest.approx(np.sqrt(t.value**2 + 0.005))
        assert t.sd > 0


def test_curves_are_those_that_objectives_are_read_off() -> None:
    names = {c.id for c in targets().curves}
    assert "vertical.toe" in names and "brake.spin" in names
    assert "roll.toe" not in names and "lateral.toe" not in names


def test_curves_can_be_added_and_dropped() -> None:
    found = targets(
        curves=[{"match": "roll.*", "objective": True}, {"match": "vertical.toe", "objective": False}]
    )
    names = {c.id for c in found.curves}
    assert "roll.camber" in names and "vertical.toe" not in names


def test_typed_targets_alone() -> None:
    found = targets([{"match": "vertical.bump_steer", "target": -5.0}], records=False)
    (only,) = found.characteristics
    assert only.value == -5.0 and only.sd == 0.0 and only.active
    assert found.curves == ()


def test_a_typed_value_goes_before_the_measured_one() -> None:
    found = targets([{"match": "vertical.bump_steer", "target": -5.0, "sd": 0.2, "low": -6.0, "high": -4.0}])
    (row,) = [t for t in found.characteristics if t.entry.id == "vertical.bump_steer"]
    assert (row.value, row.sd) == (-5.0, 0.2)
    assert row.constraint is not None and (row.constraint.low, row.constraint.high) == (-6.0, -4.0)


def test_scaled_distance_is_the_rms_over_norm() -> None:
    found = targets()
    model = curve_set(solve(nominal()))
    distance = found.scaled_curves(model) - found.scaled_targets
    rms = score(found, np.zeros(30), model).rms
    for curve, part, value in zip(found.curves, found.blocks, rms, strict=True):
        assert np.linalg.norm(distance[part]) == pytest.approx(value / curve.objective.norm)
        case = model.cases[curve.load_case]
        np.testing.assert_allclose(case.input, curve.input, atol=1e-9)
        assert value == pytest.approx(rms_deviation(case.mean[curve.response], curve.curve))


def test_passive_characteristics_are_followed_only() -> None:
    (row,) = [t for t in targets().characteristics if t.entry.id == "roll.roll_steer"]
    assert not row.active


@pytest.mark.parametrize(
    ("characteristics", "curves", "words"),
    [
        ([{"match": "vertical.bump_ster"}], [], ["fits none", "vertical.bump_steer"]),
        ([], [{"match": "vertical.tow"}], ["fits none", "vertical.toe"]),
        ([{"match": "vertical.bump_steer", "low": 9.0, "high": 1.0}], [], ["interval [9, 1]", "empty"]),
        ([{"match": "vertical.*", "target": float("nan")}], [], ["target", "finite"]),
        ([{"match": "vertical.*", "goal": "zero"}], [], ["goal is 'zero'"]),
        ([{"match": "vertical.*", "norm": 0.0}], [], ["norm is 0", "> 0"]),
        ([{"match": "vertical.*", "weight": 1.0}], [], ["key weight is unknown"]),
        ([{"match": "*", "objective": False, "constraint": False}], [], ["no characteristic has a target"]),
    ],
)
def test_one_message_for_what_is_wrong(
    characteristics: list[dict[str, Any]], curves: list[dict[str, Any]], words: list[str]
) -> None:
    with pytest.raises(InputError) as caught:
        targets(characteristics, curves)
    for word in words:
        assert word in str(caught.value)


def test_nothing_to_work_on() -> None:
    with pytest.raises(InputError, match="give measurement"):
        targets(records=False)
