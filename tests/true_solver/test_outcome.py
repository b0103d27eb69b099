"""An outcome is whole, or a failure with a reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.true_solver.outcome import Outcome, checked, failure, from_curves
from tests.campaign.toys import toy_curves

SIZE = len(CHARACTERISTICS)


def test_what_the_curves_do_not_say_is_unknown() -> None:
    found = from_curves(toy_curves(0.01), None, 0.5)
    assert not found.failed and found.seconds == 0.5
    known = {name for name, v in zip(CHARACTERISTICS, found.characteristics, strict=True) if np.isfinite(v)}
    assert known == {"static.toe", "vertical.bump_steer", "vertical.ride_rate"}


def test_a_failure_knows_nothing() -> None:
    found = failure("because")
    assert found.failed and np.isnan(found.characteristics).all() and len(found.characteristics) == SIZE
    assert checked(found).reason == "because"


def test_a_number_that_is_none_is_named() -> None:
    curves = toy_curves(0.01)
    curves.cases["vertical"].half_width["wc_z"][1, 3] = np.inf
    assert from_curves(curves, None, 0.0).reason == (
        "response not finite: load case vertical, wc_z at input -72.5 mm"
    )
    bad = replace(toy_curves(0.01), static={"toe": np.array([np.nan, 0.0])})
    assert from_curves(bad, None, 0.0).reason == "response not finite: static toe"


def test_a_line_without_slope_is_a_failure_without_a_warning() -> None:
    curves = toy_curves(0.01)
    curves.cases["vertical"].mean["wc_z"][:] = 0.0
    assert from_curves(curves, None, 0.0).reason == "characteristic not finite: vertical.bump_steer"


@pytest.mark.parametrize(
    ("value", "reason"), [(np.inf, "not finite: static.toe"), (np.nan, "no characteris")]
)
def test_characteristics_alone(value: float, reason: str) -> None:
    values = np.full(SIZE, np.nan)
    values[list(CHARACTERISTICS).index("static.toe")] = value
    assert reason in checked(Outcome(None, values, "", 0.0)).reason
    values[list(CHARACTERISTICS).index("static.toe")] = 0.1
    assert not checked(Outcome(None, values, "", 0.0)).failed
