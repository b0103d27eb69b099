"""Parallel sliders: closed forms of a loop, Masing, minor loops, work, and a measured loop of a bushing."""

from __future__ import annotations

from collections.abc import Iterable

import casadi as ca
import numpy as np
import pytest
from scipy.special import ndtri

from doe_kc.axle.sliders import normal_quantiles, yield_ratios
from doe_kc.solver.elements._sliders import lognormal_yields, slider_deflections


def yields_over_length(spread: float, count: int) -> np.ndarray:
    return np.array(ca.DM(lognormal_yields(ca.SX(spread), count))).ravel()


class Sliders:
    """Forces along a path, with the state carried."""

    def __init__(self, rates: Iterable[float], yields: Iterable[float]) -> None:
        self.rates, self.yields = np.array(list(rates)), np.array(list(yields))
        x, z = ca.SX.sym("x"), ca.SX.sym("z", self.rates.size)
        self._step = ca.Function("s", [x, z], [slider_deflections(x, z, ca.SX(self.yields), ca.SX(1))])
        self.z = np.zeros(self.rates.size)

    def to(self, x: float) -> float:
        u = np.array(self._step(x, self.z)).ravel()
        self.z = x - u
        return float(self.rates @ u)

    def along(self, xs: Iterable[float]) -> np.ndarray:
        return np.array([self.to(x) for x in xs])

    @property
    def limit(self) -> float:
        return float(self.rates @ self.yields)


def lognormal(limit: float, length: float, spread: float = 0.8, count: int = 4) -> Sliders:
    yields = length * yields_over_length(spread, count)
    return Sliders(limit / count / yields, yields)


def loop(law: Sliders, amplitude: float, points: int = 401) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(inputs rising, forces falling, forces rising) of the loop after a first rise."""
    x = np.linspace(-amplitude, amplitude, points)
    law.along(np.linspace(0.0, amplitude, points))
    falling = law.along(x[::-1])[::-1]
    return x, falling, law.along(x)


def test_area_and_half_width_of_one_slider() -> None:
    """Area 4 F (a - y), half-width F in the middle; nothing below its yield displacement."""
    law = Sliders([1000.0], [0.3])
    x, falling, rising = loop(law, 2.0)
    assert np.trapezoid(rising - falling, x) == pytest.approx(4 * 300.0 * 1.7, rel=1e-4)
    assert (rising - falling)[200] / 2 == pytest.approx(300.0)
    x, falling, rising = loop(Sliders([1000.0], [0.3]), 0.29)
    np.testing.assert_allclose(rising, falling, atol=1e-9)


def test_area_of_several_is_the_sum() -> None:
    law = lognormal(500.0, 0.2)
    x, falling, rising = loop(law, 1.0, 2001)
    closed = sum(4 * r * y * max(0.0, 1.0 - y) for r, y in zip(law.rates, law.yields, strict=True))
    assert np.trapezoid(rising - falling, x) == pytest.approx(closed, rel=1e-4)


@pytest.mark.parametrize("spread", [0.05, 0.8, 1.5])
@pytest.mark.parametrize("count", [1, 4, 8])
def test_first_touch_and_limit_are_what_they_are_called(spread: float, count: int) -> None:
    law = lognormal(500.0, 0.2, spread, count)
    assert law.to(1e-6) / 1e-6 == pytest.approx(500.0 / 0.2)
    assert law.to(1e3) == pytest.approx(500.0)


def test_masing() -> None:
    """A branch after a reversal is the first loading scaled by two."""
    law, x = lognormal(500.0, 0.2), np.linspace(0.0, 1.0, 41)
    start = law.along(x)[-1]
    np.testing.assert_allclose(start - law.along(1.0 - 2 * x), 2 * lognormal(500.0, 0.2).along(x), 1e-9, 1e-9)


def test_minor_loops_close_and_are_forgotten() -> None:
    law, plain = lognormal(500.0, 0.2), lognormal(500.0, 0.2)
    before = law.along([0.2, 0.5])[-1]
    law.along([0.3, 0.45, 0.4, 0.48, 0.3])
    assert law.to(0.5) == pytest.approx(before, rel=1e-12)
    assert law.to(0.9) == pytest.approx(plain.to(0.9), rel=1e-12)


def test_no_closed_path_gives_work_back() -> None:
    rng = np.random.default_rng(3)
    for _ in range(12):
        law = lognormal(500.0, 0.2, rng.uniform(0.1, 1.5), 4)
        corners = rng.uniform(-1.0, 1.0, 6) * rng.choice([0.05, 0.3, 2.0])
        law.along(rng.uniform(-1.0, 1.0, 3))
        pieces = [np.linspace(a, b, 40)[1:] for a, b in zip(corners, np.roll(corners, -1), strict=True)]
        path = np.concatenate([corners[:1], *pieces])
        law.along(path)  # what is left of earlier motion is stored, not dissipated
        force = law.along(path)
        assert np.trapezoid(force, path) > -1e-9


def test_quantiles_are_those_of_the_normal_distribution() -> None:
    np.testing.assert_allclose(normal_quantiles(8), ndtri((np.arange(8) + 0.5) / 8), rtol=1e-9)


def test_symbolic_and_numeric_yields_agree() -> None:
    np.testing.assert_allclose(yields_over_length(0.7, 4), yield_ratios(0.7, 4), rtol=1e-12)


MEASURED = {"half_width": (1520.0, 1640.0), "at 3 mm": 1076.0, "area": 19.8e3}
"""Radial loop of a bushing, +-3.48 mm, +-10 kN: half-width within +-2 mm (least, most) and at +-3 mm in N,
area in N mm."""
FOUR_SLIDERS = ((4465.0, 1559.0, 1534.0, 1035.0), (178.0, 278.0, 555.0, 584.0))
"""Stiffnesses in N/mm and strengths in N of the four sliders that fit it best (71 N rms of 10 kN)."""


@pytest.mark.parametrize("fitted", [True, False])
def test_a_measured_loop_of_a_bushing(fitted: bool) -> None:
    """With two numbers, the spread held, as well as with eight."""
    rates, strengths = FOUR_SLIDERS
    yields = np.divide(strengths, rates)
    x, falling, rising = loop(Sliders(rates, yields) if fitted else lognormal(1610.0, 0.26), 3.48)
    half = (rising - falling) / 2
    inside = half[np.abs(x) <= 2.0]
    assert inside.max() < MEASURED["half_width"][1] and inside.min() > MEASURED["half_width"][0]
    assert np.interp(3.0, x, half) == pytest.approx(MEASURED["at 3 mm"], rel=0.15)
    assert np.interp(-3.0, x, half) == pytest.approx(MEASURED["at 3 mm"], rel=0.15)
    assert 2 * np.trapezoid(half, x) == pytest.approx(MEASURED["area"], rel=0.01)
