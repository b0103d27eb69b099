"""Secant stiffness and loss angle over amplitude: closed forms against loops, and a measured bushing."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle.sliders import yield_ratios
from doe_kc.effects import EFFECTS
from doe_kc.effects.rubber_hysteresis import dynamic_stiffness

STIFFNESS = 1450.0


def loop(share: float, distance: float, spread: float, amplitude: float) -> tuple[float, float]:
    """(peak force in N, work in N mm) of a steady loop, driven step by step."""
    yields = distance * yield_ratios(spread)
    rates = STIFFNESS * share * distance / yields.size / yields
    quarter = np.linspace(0.0, amplitude, 400)
    falling = np.linspace(amplitude, -amplitude, 800)
    z, x_steady, force = np.zeros(yields.size), [], []
    for x in (*quarter, *falling[1:], *falling[::-1][1:]):
        u = np.clip(x - z, -yields, yields)
        z = x - u
        x_steady.append(x)
        force.append(STIFFNESS * x + rates @ u)
    at, f = np.array(x_steady[399:]), np.array(force[399:])
    return float(f[-1]), float(np.trapezoid(f, at))


@pytest.mark.parametrize("amplitude", [0.03, 0.2, 1.0, 3.0])
def test_they_are_those_of_the_loop(amplitude: float) -> None:
    law = (1.5, 0.2, 0.8)
    peak, work = loop(*law, amplitude)
    figures = dynamic_stiffness(*law, amplitude)
    assert figures.ratio == pytest.approx(peak / amplitude / STIFFNESS, rel=1e-9)
    angle = np.degrees(np.arcsin(work / (np.pi * peak * amplitude)))
    assert figures.loss_angle == pytest.approx(angle, rel=2e-3, abs=1e-9)


def test_stiff_and_without_loss_over_nothing_soft_over_much() -> None:
    tiny, huge = (dynamic_stiffness(0.5, 0.2, 0.8, a) for a in (1e-3, 1e3))
    assert tiny.ratio == pytest.approx(1.5) and tiny.loss_angle == 0.0
    assert huge.ratio == pytest.approx(1.0, abs=1e-3) and huge.loss_angle < 0.1
    ratios = [dynamic_stiffness(0.5, 0.2, 0.8, a).ratio for a in np.geomspace(0.01, 10.0, 30)]
    assert ratios == sorted(ratios, reverse=True)


def test_a_measured_bushing() -> None:
    """Radial, +-3.48 mm, +-10 kN, 19.8 J: 10.5 deg at full amplitude, friction 1610 N over 0.26 mm beside
    1450 N/mm at the centre."""
    law = (1610.0 / 0.26 / STIFFNESS, 0.26, 0.8)
    peak = 10e3 / 3.48 / STIFFNESS
    own = 1610.0 / 3.48 / STIFFNESS
    figures = dynamic_stiffness(*law, 3.48, elastic=peak - own)
    assert figures.ratio == pytest.approx(peak, rel=1e-9)
    assert figures.loss_angle == pytest.approx(10.5, abs=0.3)


def test_the_report_says_what_it_means_for_a_bench() -> None:
    sentence = EFFECTS["rubber_hysteresis"].consequence({"share": 0.5, "yield_mm": 0.2})
    for amplitude in (0.05, 0.5, 2.0):
        figures = dynamic_stiffness(0.5, 0.2, 0.8, amplitude)
        assert f"{figures.ratio:.2f}" in sentence and f"{figures.loss_angle:.1f}" in sentence
    table = EFFECTS["rubber_hysteresis"].consequence({"bushings": ["LLR"], "share": {"LLR": 0.5}})
    assert table == sentence
    assert EFFECTS["hub_compliance"].consequence({}) == ""
