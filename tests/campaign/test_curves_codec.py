"""Curves come back bit by bit, or as their fit to its accuracy, or not at all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.campaign.curve_fit import FIT_ACCURACY, polynomials
from doe_kc.campaign.curves_codec import DamagedCurves, pack, pack_fit, unpack
from doe_kc.curves import RESPONSE_UNITS, CurveSet
from doe_kc.effects import apply_effect
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


def largest_miss(one: CurveSet, other: CurveSet) -> float:
    """Of all points, in units of the accuracy."""
    return max(
        float(np.abs(curve - again[name]).max()) / FIT_ACCURACY[RESPONSE_UNITS[name]]
        for ident, case in one.cases.items()
        for curves, again in (
            (case.mean, other.cases[ident].mean),
            (case.half_width, other.cases[ident].half_width),
        )
        for name, curve in curves.items()
    )


def test_a_fit_rebuilds_every_point_to_its_accuracy() -> None:
    """With a stop's bend, loops of friction, and noise that no smooth curve follows."""
    cases = nominal().load_cases
    axle = apply_effect(nominal(), "strut_friction", {"force_N": 100.0}, source="test")
    axle = replace(axle, load_cases={i: cases[i] for i in ("vertical", "steer")})
    curves = curve_set(solve(axle, compiled=False))
    rng = np.random.default_rng(2)
    noisy = replace(
        curves,
        cases={
            i: replace(c, mean={r: m + rng.standard_normal(m.shape) for r, m in c.mean.items()})
            for i, c in curves.cases.items()
        },
    )
    for each in (curves, noisy):
        again = unpack(pack_fit(each))
        assert 0.0 < largest_miss(each, again) <= 1.0
        exact = {i: replace(c, mean=each.cases[i].mean, half_width=each.cases[i].half_width)
                 for i, c in again.cases.items()}  # fmt: skip
        assert_same(each, replace(again, cases=exact))
    assert len(pack_fit(curves)) < 0.3 * len(pack(curves))


def test_inputs_of_any_spacing_and_curves_beyond_any_axle() -> None:
    curves = toy_curves(1.0 / 3.0)
    (ident, case), *_ = curves.cases.items()
    uneven = replace(curves, cases={ident: replace(case, input=case.input**3)})
    assert largest_miss(uneven, unpack(pack_fit(uneven))) <= 1.0
    vast = replace(case, mean={r: m + 1e12 for r, m in case.mean.items()})
    beyond = replace(curves, cases={ident: vast})
    assert_same(beyond, unpack(pack_fit(beyond)))
    assert unpack(pack_fit(replace(curves, static=None))).static is None
    assert unpack(pack_fit(replace(curves, cases={}))).cases == {}


@pytest.mark.parametrize("n", [2, 5, 65])
@pytest.mark.parametrize("power", [1, 3])
def test_polynomials_are_orthonormal_and_rise_in_degree(n: int, power: int) -> None:
    x = np.linspace(-1.0, 1.0, n) ** power
    basis = polynomials(80.0 * x)
    np.testing.assert_allclose(basis.T @ basis, np.eye(n), atol=1e-12)
    for degree in range(min(n, 6)):
        fit = np.polynomial.Polynomial.fit(x, basis[:, degree], degree)
        np.testing.assert_allclose(fit(x), basis[:, degree], atol=1e-11)
    if power == 1:  # the closed form of the recurrence: Gram polynomials, Gautschi (2004), table 1.2
        k = np.arange(1, n)
        beside = np.sqrt((1.0 - (k / n) ** 2) / (4.0 - 1.0 / k**2)) * n / (n - 1.0)
        np.testing.assert_allclose(np.sum(x[:, None] * basis[:, 1:] * basis[:, :-1], axis=0), beside)


@pytest.mark.parametrize("pack", [pack, pack_fit])
def test_damage_is_noticed(pack: Callable[[CurveSet], bytes]) -> None:
    block = pack(toy_curves(0.3))
    middle = len(block) // 2
    for bad in (b"", block[:3], block[:middle], block[:-1], b"XX1" + block[3:], block[:9] + b"\xff" * 9):
        with pytest.raises(DamagedCurves):
            unpack(bad)
    with pytest.raises(DamagedCurves):
        unpack(block[:middle] + bytes([block[middle] ^ 0x55]) + block[middle + 1 :])
