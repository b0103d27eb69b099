"""Curves come back bit by bit, or not at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.campaign.curves_codec import DamagedCurves, pack, unpack
from doe_kc.curves import CurveSet
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests.campaign.toys import toy_curves
from tests.reference import nominal


def assert_same(one: CurveSet, other: CurveSet) -> None:
    assert (one.source, one.half_track, list(one.cases)) == (
        other.source,
        other.half_track,
        list(other.cases),
    )
    assert (one.static is None) == (other.static is None)
    for name, value in (one.static or {}).items():
        np.testing.assert_array_equal(value, (other.static or {})[name])
    for ident, case in one.cases.items():
        again = other.cases[ident]
        assert (case.load_case, case.input_unit) == (again.load_case, again.input_unit)
        np.testing.assert_array_equal(case.input, again.input)
        for curves, copies in ((case.mean, again.mean), (case.half_width, again.half_width)):
            assert list(curves) == list(copies)
            for name, curve in curves.items():
                assert copies[name].shape == curve.shape and copies[name].dtype == np.float64
                np.testing.assert_array_equal(curve, copies[name])


def test_what_goes_in_comes_out() -> None:
    curves = toy_curves(1.0 / 3.0)
    for each in (curves, replace(curves, static=None), replace(curves, cases={})):
        assert_same(each, unpack(pack(each)))


def test_curves_of_an_axle() -> None:
    cases = nominal().load_cases
    axle = replace(nominal(), load_cases={i: cases[i] for i in ("roll", "brake")})
    curves = curve_set(solve(axle, compiled=False))
    block = pack(curves)
    assert_same(curves, unpack(block))
    numbers = sum(c.input.size + sum(m.size for m in c.mean.values()) for c in curves.cases.values())
    assert len(block) < 0.8 * 8 * numbers


def test_damage_is_noticed() -> None:
    block = pack(toy_curves(0.3))
    middle = len(block) // 2
    for bad in (b"", block[:3], block[:middle], block[:-1], b"XX1" + block[3:], block[:9] + b"\xff" * 9):
        with pytest.raises(DamagedCurves):
            unpack(bad)
    with pytest.raises(DamagedCurves):
        unpack(block[:middle] + bytes([block[middle] ^ 0x55]) + block[middle + 1 :])
