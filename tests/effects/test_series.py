"""A friction and a spring on a compliance, against sliders that are moved through it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from doe_kc.axle.sliders import BACKBONE_YIELDS
from doe_kc.effects import EFFECTS
from doe_kc.effects._backbone import VirginCurve, virgin_curve
from doe_kc.effects._friction import BACKBONE_SHARES, DryFriction
from doe_kc.effects._series import on_compliance
from doe_kc.ground.typing import FloatArray

TWO_STAGES = np.array([0.35, 0.10, 0.03, 0.04, 0.03, 0.05, 0.40])
LIMIT, TRAVEL = 380.0, 0.11
"""N and mm, of a friction on the compliance."""
SPRING, MOUNT = 2070.0, 4350.0
"""N/mm, beside it and under both."""
RATIO = 1.0 + SPRING / MOUNT


class Sliders:
    """Elastic-slip elements in parallel, beside a spring."""

    def __init__(self, curve: VirginCurve, limit: float, spring: float) -> None:
        """The curve's distances are those at which one of them yields."""
        x = np.concatenate([[0.0], curve.distances])
        slopes = np.diff(np.concatenate([[0.0], curve.shares])) / np.diff(x)
        self.rates = limit * (slopes - np.append(slopes[1:], 0.0))
        self.yields, self.spring = curve.distances, spring
        self.stretch = np.zeros(curve.distances.size)
        self.at = 0.0

    def force(self, x: float) -> float:
        return float(self.spring * x + self.rates @ self._stretched(x))

    def move(self, x: float) -> float:
        force, self.stretch = self.force(x), self._stretched(x)
        self.at = x
        return force

    def _stretched(self, x: float) -> FloatArray:
        return np.clip(self.stretch + x - self.at, -self.yields, self.yields)


def two_stages() -> VirginCurve:
    """Over its limit, at the distances, mm, where its sliders yield."""
    at = TRAVEL * np.array(BACKBONE_YIELDS)
    return VirginCurve(at, np.minimum(at[:, None] / at, 1.0) @ TWO_STAGES, TRAVEL)


def motion() -> FloatArray:
    """(400,) mm, loops within loops."""
    t = np.linspace(0.0, 6.0 * np.pi, 400)
    return np.asarray(0.9 * np.sin(t) * (1.0 - 0.12 * t / np.pi))


def on_the_mount(sliders: Sliders, y: float) -> float:
    x = brentq(lambda x: sliders.force(x) - MOUNT * (y - x), -5.0, 5.0, xtol=1e-13)
    return sliders.move(x)


def test_smaller_ones_on_a_rigid_mount_make_exactly_the_same_loops() -> None:
    """380 N beside 2070 N/mm on 4350 N/mm are 257 N beside 1402."""
    yielding = Sliders(two_stages(), LIMIT, SPRING)
    rigid = Sliders(on_compliance(two_stages(), LIMIT / SPRING, 1.0 / RATIO), LIMIT / RATIO, SPRING / RATIO)
    there = [on_the_mount(yielding, y) for y in motion()]
    np.testing.assert_allclose([rigid.move(y) for y in motion()], there, atol=1e-8)


def test_a_mount_and_none_lead_back_to_the_same_curve() -> None:
    rigid = on_compliance(two_stages(), LIMIT / SPRING, 1.0 / RATIO)
    back = on_compliance(rigid, LIMIT / SPRING, RATIO)
    np.testing.assert_allclose(back.distances, two_stages().distances, rtol=1e-12)


def test_a_compliance_that_would_take_more_than_all_leaves_something() -> None:
    short = on_compliance(two_stages(), 100.0 * LIMIT / SPRING, RATIO)
    assert (short.distances > 0.0).all() and (np.diff(short.distances) >= 0.0).all()


@pytest.mark.parametrize("law", ["backbone", "lognormal", "dahl", "duhem", "iwan"])
def test_options_of_an_effect_are_those_of_the_friction_on_the_mount(law: str) -> None:
    """By a law of few numbers the limit is the same, and so is the distance of half of it."""
    effect = EFFECTS["steering_friction"]
    assert isinstance(effect, DryFriction)
    rigid = on_compliance(two_stages(), LIMIT / SPRING, 1.0 / RATIO)
    free = effect.numbers_by("backbone", {"force_N": LIMIT / RATIO, "presliding_mm": rigid.typical})
    known = dict(free) | {"law": "backbone"}
    there = effect.on_compliance(law, known, SPRING / RATIO, RATIO)
    assert there["force_N"] == pytest.approx(RATIO * known["force_N"], rel=0.02)
    numbers = effect.read(dict(there) | {"law": law}, "")
    own = virgin_curve(law, numbers["exponent"], numbers["spread"], numbers["shares"])  # type: ignore[arg-type]
    at = known["presliding_mm"]
    curve = virgin_curve("backbone", 1.0, 1.0, known["shares"])
    exact = on_compliance(curve, known["force_N"] * RATIO / SPRING / at, RATIO)
    half = there["presliding_mm"] * own.distance(0.5)
    assert half == pytest.approx(at * exact.distance(0.5), rel=0.1 if law == "backbone" else 1e-6)


def test_shares_lead_to_the_free_shape_of_the_car() -> None:
    """What the rigid mount's friction of free shape is on a compliance: nearly that of two stages again."""
    effect = EFFECTS["steering_friction"]
    assert isinstance(effect, DryFriction)
    known = {"force_N": LIMIT, "presliding_mm": TRAVEL, "law": "backbone", "shares": TWO_STAGES.tolist()}
    rigid = effect.on_compliance("backbone", known, SPRING, 1.0 / RATIO)
    assert rigid["force_N"] == pytest.approx(LIMIT / RATIO, rel=0.01)
    back = effect.on_compliance("backbone", dict(rigid) | {"law": "backbone"}, SPRING / RATIO, RATIO)
    assert back["force_N"] == pytest.approx(LIMIT, rel=0.01)
    assert back["presliding_mm"] == pytest.approx(TRAVEL, rel=0.15)
    np.testing.assert_allclose(back["shares"], TWO_STAGES, atol=0.09)
    usual = np.abs(np.array(BACKBONE_SHARES) - TWO_STAGES)
    assert np.abs(np.array(back["shares"]) - TWO_STAGES).sum() < 0.5 * usual.sum()


@pytest.mark.parametrize("effect", [e for e in EFFECTS.values() if e.spring], ids=lambda e: e.id)
def test_a_compliance_with_a_spring_is_one_of_a_part_with_a_friction(effect: object) -> None:
    own = next(e for e in EFFECTS.values() if e is effect)
    assert [size.growth for size in own.sizes if not size.shape] == ["compliance"]
    assert any(isinstance(e, DryFriction) and e.part == own.part for e in EFFECTS.values())


@pytest.mark.parametrize("factor", [0.55, 1.8])
def test_other_sliders_make_nearly_the_same_curve(factor: float) -> None:
    """As far as they reach: the last one of two stages yields at five travels."""
    effect = EFFECTS["steering_friction"]
    assert isinstance(effect, DryFriction)
    known = {"force_N": LIMIT, "presliding_mm": TRAVEL, "law": "backbone", "shares": TWO_STAGES.tolist()}
    there = effect.with_travel(known, factor)
    assert there["presliding_mm"] == pytest.approx(factor * TRAVEL)
    own, other = (virgin_curve("backbone", 1.0, 1.0, n["shares"]) for n in (known, there))
    at = np.geomspace(0.1, 10.0, 40) * TRAVEL
    here = np.interp(at, TRAVEL * own.distances, LIMIT * own.shares)
    moved = np.interp(at, there["presliding_mm"] * other.distances, there["force_N"] * other.shares)
    alone = np.interp(at, factor * TRAVEL * own.distances, LIMIT * own.shares)
    left, travel = (np.sqrt(np.mean((curve - here) ** 2)) for curve in (moved, alone))
    assert left < 0.05 * LIMIT and left < 0.5 * travel


def test_a_closed_law_begins_where_the_free_shape_is() -> None:
    effect = EFFECTS["steering_friction"]
    assert isinstance(effect, DryFriction)
    wide = {"force_N": LIMIT, "presliding_mm": TRAVEL, "law": "lognormal", "spread": 1.0}
    free = effect.numbers_by("backbone", wide)
    back = effect.numbers_by("lognormal", dict(free) | {"law": "backbone"})
    assert back["spread"] == pytest.approx(1.0, rel=0.25)
    assert back["presliding_mm"] == pytest.approx(TRAVEL, rel=0.25)
    assert back["force_N"] == free["force_N"]
    assert set(effect.numbers_by("", dict(free) | {"law": "backbone"})) == {"force_N", "presliding_mm"}
