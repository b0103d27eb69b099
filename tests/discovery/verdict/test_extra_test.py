"""Further load cases: none tells an explanation from itself or from a twin, some tell unlike ones apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.verdict.extra_test import extra_tests
from tests.discovery.cases import discovery


def trials(car: str) -> dict[str, Fit]:
    first = discovery(car).search.first
    return {t.hypothesis.effect: t.fit for t in reversed(first.trials)}


def test_nothing_tells_a_fit_from_itself() -> None:
    own = trials("named")["hub_compliance"]
    assert extra_tests(own, own) == ()


def test_a_steer_arm_and_a_tie_rod_stay_alike() -> None:
    found = discovery("class")
    words = found.next_tests[0]
    assert "No further load case" in words
    assert "tie-rod compliance" in words and "steer-arm compliance" in words


def test_unlike_effects_are_told_apart_and_the_best_comes_first() -> None:
    fits = trials("named")
    other = next(f for name, f in fits.items() if name != "hub_compliance")
    found = extra_tests(fits["hub_compliance"], other)
    assert found and "up to 3000 N" in found[0].words
    assert [t.separation for t in found] == sorted((t.separation for t in found), reverse=True)


def test_what_is_less_known_separates_less() -> None:
    """With its parameters hardly known, the other explanation follows the further load case too."""
    fits = trials("named")
    own, other = fits["hub_compliance"], next(f for n, f in fits.items() if n != "hub_compliance")
    blurred = replace(other, jacobian=Jacobian(0.1 * other.jacobian.dense))
    assert np.trace(blurred.covariance) > np.trace(other.covariance)
    assert extra_tests(own, blurred)[0].separation < extra_tests(own, other)[0].separation
