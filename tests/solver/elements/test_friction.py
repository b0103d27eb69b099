"""Dahl and Prandtl-Iwan friction along prescribed motions."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import casadi as ca
import numpy as np
import pytest
from scipy.optimize import nnls

from doe_kc.axle.sliders import BACKBONE_YIELDS, IWAN_ELEMENTS
from doe_kc.effects._friction import BACKBONE_SHARES
from doe_kc.solver.elements.friction import (
    add_friction,
    dahl_force,
    duhem_force,
)
from tests.solver.elements.mini import builder

LEVEL, PRE = 250.0, 0.05
LAWS = ("dahl", "duhem", "iwan", "lognormal", "backbone")
SLIDERS = LAWS[2:]
SHAPES = {
    "f.exponent": 1.0,
    "f.spread": 0.8,
    **{f"f.share{i}": share for i, share in enumerate(BACKBONE_SHARES)},
}
"""Numbers of the laws' shapes by parameter."""


class Law:
    """One frictional slide with its state."""

    def __init__(self, law: str, on: float = 1.0, shape: dict[str, float] | None = None) -> None:
        b, x = builder(), ca.SX.sym("x")
        force = add_friction(b, "rack", law, x, "f", "")  # type: ignore[arg-type]
        (before, after) = b.states[0]
        symbols, expressions = (list(column) for column in zip(*b.constants, strict=True))
        _, out = ca.substitute_inplace(symbols, expressions, [force, after])
        chosen = SHAPES | (shape or {})
        shapes = [n for n in b.parameters if n in chosen]
        parameters = [b.parameters[n] for n in ("f.force", "f.presliding", *shapes)]
        self._call = ca.Function("law", [x, before, *parameters, b.controls["load_case"]], out)
        self.numbers = (LEVEL, PRE, *(chosen[n] for n in shapes), on)
        self.z = np.zeros(before.numel())
        self.resistance = b.resistances["rack"]

    def to(self, x: float) -> float:
        force, z = self._call(x, self.z, *self.numbers)
        self.z = np.array(z).ravel()
        return float(force)

    def along(self, xs: Iterable[float]) -> np.ndarray:
        return np.array([self.to(x) for x in xs])


def virgin(x: np.ndarray) -> np.ndarray:
    return LEVEL * (1 - np.exp(-x / PRE))


def test_dahl_is_the_closed_form_of_a_monotone_step() -> None:
    """dF/dx = (Fc / x_pre) (1 - F / Fc sgn dx), integrated by small steps."""
    x = np.linspace(0.02, 0.12, 200001)
    f = -80.0
    for dx in np.diff(x):
        f += LEVEL / PRE * (1 - f / LEVEL) * dx
    exact = float(dahl_force(ca.SX(0.12), ca.SX(0.02), ca.SX(-80.0), ca.SX(LEVEL), ca.SX(PRE)))
    assert exact == pytest.approx(f, rel=1e-5)
    back = float(dahl_force(ca.SX(-0.08), ca.SX(0.02), ca.SX(80.0), ca.SX(LEVEL), ca.SX(PRE)))
    assert back == pytest.approx(-exact)


@pytest.mark.parametrize("law", LAWS)
def test_a_monotone_step_may_be_split(law: str) -> None:
    whole, parts, at = Law(law), Law(law), 0.0
    for turning in (0.13, -0.04, 0.02):
        pieces = parts.along(np.linspace(at, turning, 8)[1:])
        assert whole.to(turning) == pytest.approx(pieces[-1], rel=1e-12)
        np.testing.assert_allclose(whole.z, parts.z, rtol=1e-12, atol=1e-13)
        at = turning


@pytest.mark.parametrize("law", LAWS)
def test_the_force_saturates_at_its_level_and_opposes_the_motion(law: str) -> None:
    f = Law(law)
    assert f.to(5.0) == pytest.approx(LEVEL)
    assert f.to(-5.0) == pytest.approx(-LEVEL)


@pytest.mark.parametrize("law", LAWS)
def test_off_there_is_no_force_and_the_state_forgets(law: str) -> None:
    off = Law(law, on=0.0)
    assert off.to(3.0) == 0.0
    off.numbers = (*off.numbers[:-1], 1.0)
    # F = 0 where it was switched on
    assert off.to(3.0) == 0.0
    assert off.to(3.01) > 0.0


def test_the_iwan_virgin_curve_is_dahl_s_within_its_discretization() -> None:
    x = np.linspace(0.0, 0.4, 81)
    error = np.abs(Law("iwan").along(x) - virgin(x))
    assert error.max() < LEVEL / IWAN_ELEMENTS / 2
    np.testing.assert_allclose(Law("dahl").along(x), virgin(x), rtol=1e-12, atol=1e-10)


def test_iwan_closes_minor_loops_where_dahl_ratchets() -> None:
    """20 small reversals, between 0.05 and 0.06 mm."""
    drift = {}
    for law in ("dahl", "iwan"):
        f = Law(law)
        first = f.to(0.06)
        for _ in range(20):
            f.to(0.05)
            last = f.to(0.06)
        drift[law] = abs(last - first)
    assert drift["iwan"] < 1e-9 * LEVEL
    assert drift["dahl"] > 0.1 * LEVEL


@pytest.mark.parametrize("law", SLIDERS)
def test_sliders_obey_masing(law: str) -> None:
    """A branch after a reversal is the virgin curve scaled by two."""
    f, x = Law(law), np.linspace(0.0, 0.2, 41)
    start = f.along(np.linspace(0.0, 0.2, 5))[-1]
    returning = f.along(0.2 - 2 * x[1:])
    np.testing.assert_allclose(start - returning, 2 * Law(law).along(x[1:]), rtol=1e-9)


def test_all_laws_are_alike_as_they_come() -> None:
    """So that a change of the law alone begins near the one before."""
    x = np.linspace(0.0, 0.5, 101)
    for law, most in (("lognormal", 0.11), ("backbone", 0.07)):
        assert np.abs(Law(law).along(x) - virgin(x)).max() < most * LEVEL


def test_a_small_spread_is_one_slider() -> None:
    x = np.linspace(0.0, 0.2, 41)
    sharp = Law("lognormal", shape={"f.spread": 1e-3}).along(x)
    np.testing.assert_allclose(sharp, np.minimum(LEVEL * x / PRE, LEVEL), atol=0.002 * LEVEL)


@pytest.mark.parametrize(
    "backbone",
    [lambda u: u / (1 + u), np.tanh, lambda u: np.minimum(u, 1.0), lambda u: 2 / np.pi * np.arctan(u)],
    ids=["Berg", "tanh", "Jenkins", "arctan"],
)
def test_free_shares_come_near_any_backbone(backbone: Callable[[np.ndarray], np.ndarray]) -> None:
    """Shares by least squares of first loadings up to five lengths, none of them negative."""
    u = np.linspace(0.0, 5.0, 201)
    columns = np.column_stack([np.minimum(u / y, 1.0) for y in BACKBONE_YIELDS])
    shares = nnls(columns, backbone(u))[0] + 1e-9
    law = Law("backbone", shape={f"f.share{i}": share for i, share in enumerate(shares)})
    law.numbers = (LEVEL * shares.sum(), *law.numbers[1:])
    np.testing.assert_allclose(law.along(PRE * u), LEVEL * backbone(u), atol=0.02 * LEVEL)


def test_the_force_is_what_resists_the_slide() -> None:
    b, x = builder(), ca.SX.sym("x")
    force = add_friction(b, "strut slide L", "dahl", x, "strut_friction", "L")
    assert ca.is_equal(ca.simplify(b.resistances["strut slide L"] - force), ca.SX(0), 3)
    assert set(b.parameters) == {"strut_friction.force@L", "strut_friction.presliding@L"}


@pytest.mark.parametrize("exponent", [0.5, 1.0, 1.3, 2.0])
def test_duhem_is_its_differential_equation(exponent: float) -> None:
    """Integrated by small steps, up, and down from there."""
    law, f, x = Law("duhem", shape={"f.exponent": exponent}), 0.0, 0.0
    for end in (0.07, -0.02):
        steps = np.linspace(x, end, 20001)
        sign = np.sign(end - x)
        for dx in np.diff(steps):
            f += LEVEL / PRE * max(1 - sign * f / LEVEL, 0.0) ** exponent * dx
        assert law.to(end) == pytest.approx(f, rel=2e-4)
        x = end


def test_duhem_leaves_dahl_s_exponent() -> None:
    """Its force has a derivative there, against differences: a fit that begins at Dahl's law moves on."""
    symbols = [ca.SX.sym(name) for name in ("x", "x0", "f0", "level", "presliding", "exponent")]
    force = duhem_force(*symbols)
    slope = ca.Function("slope", symbols, [ca.jacobian(force, symbols[-1])])
    value = ca.Function("force", symbols, [force])
    for x, start in ((0.02, 0.0), (0.1, 0.0), (0.1, -200.0), (-0.05, 200.0)):
        at = (x, 0.0, start, LEVEL, PRE)
        differences = (float(value(*at, 1.01)) - float(value(*at, 0.99))) / 0.02
        assert abs(differences) > 1.0
        assert float(slope(*at, 1.0)) == pytest.approx(differences, rel=1e-3)


def test_duhem_with_exponent_one_is_dahl_and_two_loads_as_berg() -> None:
    x = np.linspace(0.0, 0.5, 51)
    path = np.concatenate([x, 0.5 - 2 * x])
    np.testing.assert_allclose(Law("duhem").along(path), Law("dahl").along(path), atol=2e-3)
    berg = LEVEL * x / (PRE + x)
    np.testing.assert_allclose(Law("duhem", shape={"f.exponent": 2.0}).along(x), berg, rtol=1e-9, atol=1e-9)
