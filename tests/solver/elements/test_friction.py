"""Dahl and Prandtl-Iwan friction along prescribed motions."""

from __future__ import annotations

from collections.abc import Iterable

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver.elements.friction import IWAN_ELEMENTS, add_friction, dahl_force, iwan_yields
from tests.solver.elements.mini import builder

LEVEL, PRE = 250.0, 0.05


class Law:
    """One frictional slide with its state."""

    def __init__(self, law: str, on: float = 1.0) -> None:
        b, x = builder(), ca.SX.sym("x")
        force = add_friction(b, "rack", law, x, "f", "")  # type: ignore[arg-type]
        (before, after) = b.states[0]
        constants = dict(zip([s for s, _ in b.constants], [e for _, e in b.constants], strict=True))
        _, out = ca.substitute_inplace(list(constants), list(constants.values()), [force, after])
        parameters = [b.parameters["f.force"], b.parameters["f.presliding"], b.controls["friction"]]
        self._call = ca.Function("law", [x, before, *parameters], out)
        self.numbers = (LEVEL, PRE, on)
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


@pytest.mark.parametrize("law", ["dahl", "iwan"])
def test_a_monotone_step_may_be_split(law: str) -> None:
    whole, parts, at = Law(law), Law(law), 0.0
    for turning in (0.13, -0.04, 0.02):
        pieces = parts.along(np.linspace(at, turning, 8)[1:])
        assert whole.to(turning) == pytest.approx(pieces[-1], rel=1e-12)
        np.testing.assert_allclose(whole.z, parts.z, rtol=1e-12, atol=1e-13)
        at = turning


@pytest.mark.parametrize("law", ["dahl", "iwan"])
def test_the_force_saturates_at_its_level_and_opposes_the_motion(law: str) -> None:
    f = Law(law)
    assert f.to(5.0) == pytest.approx(LEVEL)
    assert f.to(-5.0) == pytest.approx(-LEVEL)


@pytest.mark.parametrize("law", ["dahl", "iwan"])
def test_off_there_is_no_force_and_the_state_forgets(law: str) -> None:
    off = Law(law, on=0.0)
    assert off.to(3.0) == 0.0
    off.numbers = (LEVEL, PRE, 1.0)
    # F = 0 where it was switched on
    assert off.to(3.0) == 0.0
    assert off.to(3.01) > 0.0


def test_yield_displacements_are_those_of_the_exponential_virgin_curve() -> None:
    """Equal-strength elements at mid-quantiles of the density y exp(-y)."""
    y = iwan_yields(4)
    np.testing.assert_allclose(1 - (1 + y) * np.exp(-y), (np.arange(4) + 0.5) / 4, rtol=1e-9)


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


def test_iwan_obeys_masing() -> None:
    """A branch after a reversal is the virgin curve scaled by two."""
    f, x = Law("iwan"), np.linspace(0.0, 0.2, 41)
    start = f.along(np.linspace(0.0, 0.2, 5))[-1]
    returning = f.along(0.2 - 2 * x[1:])
    np.testing.assert_allclose(start - returning, 2 * Law("iwan").along(x[1:]), rtol=1e-9)


def test_the_force_is_what_resists_the_slide() -> None:
    b, x = builder(), ca.SX.sym("x")
    force = add_friction(b, "strut slide L", "dahl", x, "strut_friction", "L")
    assert ca.is_equal(ca.simplify(b.resistances["strut slide L"] - force), ca.SX(0), 3)
    assert set(b.parameters) == {"strut_friction.force@L", "strut_friction.presliding@L"}
