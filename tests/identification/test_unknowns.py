"""What may change, how far, and what is said of what may not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from doe_kc.axle import parameter_value, with_values
from doe_kc.ground.errors import InputError
from doe_kc.identification.unknowns import Free, unknowns
from tests.reference import nominal


def test_positions_move_by_mm_and_sizes_by_ratios() -> None:
    u = unknowns(nominal(), {"LLF.z": 4.0, "llr.Fx": 3.0, "steering.column": 2.0}, "test")
    values = u.values(np.array([0.5, -1.0, 2.0]))
    np.testing.assert_allclose(values, [214.0, 1.0 / 3.0, 4.0 * 2070.0])
    axle = u.axle_at(np.array([0.5, -1.0, 2.0]))
    assert parameter_value(axle, "LLF.z") == 214.0
    assert parameter_value(axle, "steering.column") == pytest.approx(8280.0)
    lower, upper = u.bounds()
    np.testing.assert_allclose([lower[0], upper[0]], [202.0, 222.0])
    np.testing.assert_allclose([lower[1], upper[1]], [3.0**-2.5, 3.0**2.5])
    sd = u.sd_of_values(np.zeros(3), np.array([1.0, 0.5, 1.0]))
    np.testing.assert_allclose(sd, [4.0, 0.5 * math.log(3.0), 2070.0 * math.log(2.0)])
    assert u.units == ("mm", "-", "")


def test_globs_meet_hardpoints_and_declared_sizes_once() -> None:
    u = unknowns(nominal(), ["llf.*", "U*.x"], "test")
    assert u.paths == (*(f"llf.{a}{i}" for a in "FT" for i in "xyz"), "UPB.x", "UPBBI.x", "UPS.x")
    assert unknowns(nominal(), {"LLF.?": 5.0, "LLF.y": 2.0}, "test").sd.tolist() == [5.0, 2.0, 5.0]


def test_by_default_hardpoints_and_bushings_of_the_equations() -> None:
    u = unknowns(nominal(), None, "test")
    assert len(u.paths) == 33 + 31 and u.paths[-1] == "scb.Tz" and u.sized.sum() == 31
    assert set(np.round(u.sd[~u.sized], 9)) == {10.0}


def test_a_flexibility_is_a_size_once_it_is_above_zero() -> None:
    with pytest.raises(InputError, match="matches no coordinate"):
        unknowns(nominal(), ["strut.flexibility"], "test")
    soft = with_values(nominal(), {"strut.flexibility": 0.5})
    u = unknowns(soft, ["strut.flexibility"], "test")
    assert u.values(np.array([1.0])).tolist() == [pytest.approx(0.5 * 2.5)]


@pytest.mark.parametrize(
    ("free", "words"),
    [
        (["LLG.x"], 'matches no coordinate.*mean "LL[FR].x"'),
        (["static.toe"], "matches no coordinate"),
        (["steer_arm.radius"], "matches no coordinate"),
        ({"llr.Fx": 0.5}, "llr.Fx has the standard deviation 0.5, expected a ratio > 1"),
        ({"LLF.x": -1.0}, "expected mm > 0"),
        ("LLF.x", "expected a list"),
        ([], "free names no parameter"),
    ],
)
def test_what_cannot_be_free(free: Free, words: str) -> None:
    with pytest.raises(InputError, match=words):
        unknowns(nominal(), free, "test")
