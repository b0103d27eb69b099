"""The free backbone that does nearly what a closed law does, against both laws as they are solved."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle.sliders import BACKBONE_YIELDS, IWAN_ELEMENTS, yield_ratios
from doe_kc.effects._backbone import VirginCurve, nearest_backbone, nearest_shape, virgin_curve
from doe_kc.effects._friction import BACKBONE_SHARES
from tests.solver.elements.test_friction import LEVEL, PRE, Law

CLOSED = [
    ("dahl", {}),
    ("iwan", {}),
    ("duhem", {"f.exponent": 0.7}),
    ("duhem", {"f.exponent": 1.5}),
    ("lognormal", {"f.spread": 0.4}),
    ("lognormal", {"f.spread": 0.8}),
]
"""Laws with the numbers of their shape."""


def loop(law: Law) -> np.ndarray:
    """(120,) force along a wide loop, after one that brought the law there."""
    there = 10.0 * PRE * np.sin(np.linspace(0.0, 2.5 * np.pi, 301))
    back = there[-1] * np.cos(np.linspace(0.0, 2.0 * np.pi, 121))[1:]
    law.along(there)
    return law.along(back)


@pytest.mark.parametrize(("law", "shape"), CLOSED)
def test_it_makes_the_loop_of_the_law(law: str, shape: dict[str, float]) -> None:
    curve = virgin_curve(
        law,  # type: ignore[arg-type]
        shape.get("f.exponent", 1.0),
        shape.get("f.spread", 0.8),
        BACKBONE_SHARES,
    )
    free = nearest_backbone(curve, BACKBONE_SHARES)
    backbone = Law("backbone", shape={f"f.share{i}": share for i, share in enumerate(free.shares)})
    backbone.numbers = (free.limit * LEVEL, free.travel * PRE, *backbone.numbers[2:])
    left = loop(backbone) - loop(Law(law, shape=shape))
    assert np.sqrt(np.mean(left**2)) < 0.015 * LEVEL
    usual = loop(Law("backbone")) - loop(Law(law, shape=shape))
    assert np.sqrt(np.mean(left**2)) < 0.7 * np.sqrt(np.mean(usual**2))
    assert sum(free.shares) == pytest.approx(1.0) and min(free.shares) > 0.0


def test_a_law_that_reaches_its_limit_far_away_has_less_of_it() -> None:
    far = nearest_backbone(virgin_curve("lognormal", 1.0, 1.5, BACKBONE_SHARES), BACKBONE_SHARES)
    assert 0.85 < far.limit < 0.98 and far.travel > 1.0


@pytest.mark.parametrize(("spread", "near"), [(0.8, 0.01), (1.5, 0.02), (2.9, 0.05)])
def test_a_law_of_wide_spread_is_met_about_its_median(spread: float, near: float) -> None:
    """Its sliders yield at 0.2 to 290 times limit over initial stiffness: within 20 of those the nearest one
    left 14 % of the limit, and a friction of two stages that began there ended 3600 of cost too high."""
    yields = yield_ratios(spread, IWAN_ELEMENTS)
    distances = float(np.median(yields)) * np.geomspace(0.05, 20.0, 50)[:, None]
    free = nearest_backbone(virgin_curve("lognormal", 1.0, spread, BACKBONE_SHARES), BACKBONE_SHARES)
    own = np.minimum(distances / (free.travel * np.array(BACKBONE_YIELDS)), 1.0) @ np.array(free.shares)
    left = free.limit * own - np.minimum(distances / yields, 1.0).mean(axis=1)
    assert np.sqrt(np.mean(left**2)) < near


@pytest.mark.parametrize(("law", "shape"), [*CLOSED, ("backbone", {})])
def test_the_virgin_curve_is_half_a_branch_of_the_loop(law: str, shape: dict[str, float]) -> None:
    """From one limit to the other, at twice the distances and the forces."""
    shares = [0.35, 0.10, 0.03, 0.04, 0.03, 0.05, 0.40]
    curve = virgin_curve(law, shape.get("f.exponent", 1.0), shape.get("f.spread", 0.8), shares)  # type: ignore[arg-type]
    numbers = {f"f.share{i}": share for i, share in enumerate(shares)} if law == "backbone" else {}
    solved = Law(law, shape=shape | numbers)
    solved.along(np.linspace(0.0, 200.0 * PRE, 2001))
    here, start = 200.0 * PRE, solved.to(200.0 * PRE)
    branch = start - solved.along(here - 2.0 * PRE * curve.distances)
    np.testing.assert_allclose(curve.shares, branch / (2.0 * LEVEL), atol=0.004)


@pytest.mark.parametrize(("law", "shape"), CLOSED)
def test_a_law_is_nearest_to_its_own_curve(law: str, shape: dict[str, float]) -> None:
    """Over another travel: within half a step of the numbers that are tried."""
    number = next(iter(shape.values()), None)
    exponent, spread = shape.get("f.exponent", 1.0), shape.get("f.spread", 0.8)
    own = virgin_curve(law, exponent, spread, BACKBONE_SHARES)  # type: ignore[arg-type]
    there = VirginCurve(3.0 * own.distances, own.shares, 3.0 * own.typical)
    near = nearest_shape(there, law)  # type: ignore[arg-type]
    assert near.number == (None if number is None else pytest.approx(number, rel=0.12))
    assert near.travel == pytest.approx(3.0, rel=0.06 if law == "duhem" else 0.16 if number else 1e-9)


@pytest.mark.parametrize("spread", [0.4, 0.8, 1.0])
def test_the_law_is_found_again_from_the_free_backbone_near_it(spread: float) -> None:
    """From spreads of 0.8 and the same travel 323 N on 6490 N/mm ended there, for 363 N on 3820 N/mm."""
    free = nearest_backbone(virgin_curve("lognormal", 1.0, spread, BACKBONE_SHARES), BACKBONE_SHARES)
    curve = virgin_curve("backbone", 1.0, 1.0, free.shares)
    near = nearest_shape(curve, "lognormal")
    assert near.number == pytest.approx(spread, rel=0.25)
    assert near.travel * free.travel == pytest.approx(1.0, rel=0.25)


def test_the_distance_of_a_share_is_where_the_curve_has_it() -> None:
    curve = virgin_curve("dahl", 1.0, 1.0, BACKBONE_SHARES)
    assert curve.distance(0.5) == pytest.approx(0.5 * np.log(2.0), rel=0.01)
    assert curve.distance(2.0) == curve.distances[-1]
