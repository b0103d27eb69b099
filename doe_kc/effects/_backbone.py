"""Virgin curves of dry frictions, and the free backbone and the closed law that come near to one.

A law of sliders obeys Masing's rule: a branch after a reversal is its virgin curve twice as large. Dahl's and
Duhem's do not; of theirs the branch from one limit to the other counts, half as large, as a rig runs over
such loops and sees little of a first loading. By it Dahl's law is an exponential backbone of half its travel.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.sliders import BACKBONE_YIELDS, IWAN_ELEMENTS, iwan_yields, yield_ratios
from doe_kc.axle.topology import NEARLY_DAHL, FrictionLaw
from doe_kc.ground.typing import FloatArray

DISTANCES = np.geomspace(0.05, 20.0, 80)
"""Over the typical yield displacement of the law, at which the curves are compared."""
TRAVEL_FACTORS = np.geomspace(0.25, 4.0, 33)
"""Travels of the backbone that are tried, over that yield displacement."""
UNUSED_SHARE = 0.005
"""-, of a slider that the curve has no use for: none would hold the fit that begins there."""
SHAPE_NUMBERS: Mapping[FrictionLaw, FloatArray] = {
    "duhem": np.geomspace(0.5, 4.0, 13),
    "lognormal": np.geomspace(0.1, 3.0, 18),
}
"""-, exponents and spreads that are tried, a fifth apart."""
PULL = 0.05
"""-, of a share to the usual one, where the curve says little: over the weight of one point of the curve."""


@dataclass(frozen=True)
class VirginCurve:
    """Of a friction: how much of its limit it has at some distances from where it has none."""

    distances: FloatArray
    """(n,) rising, in any unit."""
    shares: FloatArray
    """(n,) force over the limit, rising."""
    typical: float
    """Yield displacement, about which those of its sliders lie."""

    def distance(self, share: float) -> float:
        """At which the friction has a share of its limit; where it never has, the last one."""
        return float(np.interp(share, self.shares, self.distances))


@dataclass(frozen=True)
class Backbone:
    """A free backbone near the virgin curve of a friction."""

    limit: float
    """Over that of the friction: less where that reaches its own farther away than the curve goes."""
    travel: float
    """In the unit of the curve's distances."""
    shares: tuple[float, ...]
    """Of the sliders in the limit, of sum 1."""


@dataclass(frozen=True)
class ClosedShape:
    """A closed law near the virgin curve of a friction, of the same limit."""

    travel: float
    """In the unit of the curve's distances."""
    number: float | None
    """Exponent of duhem, spread of lognormal; None of a law without one."""


def virgin_curve(law: FrictionLaw, exponent: float, spread: float, shares: Sequence[float]) -> VirginCurve:
    """Of a law, its distances over its travel.

    exponent: of duhem only; spread: of lognormal only; shares: of backbone only, in proportion.
    """
    typical = _typical_yield(law, spread)
    distances = typical * DISTANCES
    return VirginCurve(distances, _loading(law, exponent, spread, shares, distances), typical)


def nearest_backbone(
    curve: VirginCurve, usual: Sequence[float], travels: FloatArray | None = None
) -> Backbone:
    """The backbone of least squares from a curve.

    usual: shares where the curve says nothing. travels: (n,) that it may have, in the unit of the curve's
    distances; None for those about the typical yield displacement.
    """
    share = np.array(usual)
    among = curve.typical * TRAVEL_FACTORS if travels is None else travels
    trials = [(_shares(curve, travel, share), travel) for travel in among.tolist()]
    (shares, _), travel = min(trials, key=lambda trial: trial[0][1])
    shares = np.maximum(shares, UNUSED_SHARE)
    return Backbone(float(shares.sum()), travel, tuple((shares / shares.sum()).tolist()))


def nearest_shape(curve: VirginCurve, law: FrictionLaw) -> ClosedShape:
    """The closed law that has half of its limit where a curve has, of least squares from it among
    SHAPE_NUMBERS."""
    trials = [_at_half(curve, law, number) for number in SHAPE_NUMBERS.get(law, np.ones(1)).tolist()]
    _, travel, number = min(trials)
    return ClosedShape(travel, number if law in SHAPE_NUMBERS else None)


def _at_half(curve: VirginCurve, law: FrictionLaw, number: float) -> tuple[float, float, float]:
    """Square of what the law of a number leaves of a curve, its travel, and the number."""
    own = virgin_curve(law, exponent=number, spread=number, shares=())
    travel = curve.distance(0.5) / own.distance(0.5)
    distances, shares = (np.append(0.0, values) for values in (travel * own.distances, own.shares))
    left = np.interp(curve.distances, distances, shares) - curve.shares
    return float(left @ left), travel, number


def _shares(curve: VirginCurve, travel: float, usual: FloatArray) -> tuple[FloatArray, float]:
    """Shares of least squares, none below 0, and the norm of what they leave."""
    from scipy.optimize import nnls  # a quarter of a second, which no other command has a use for

    virgin = _virgin(travel * np.array(BACKBONE_YIELDS), curve.distances)
    shares, misfit = nnls(
        np.vstack([virgin, PULL * np.eye(usual.size)]), np.concatenate([curve.shares, PULL * usual])
    )
    return shares, float(misfit)


def _typical_yield(law: FrictionLaw, spread: float) -> float:
    """Yield displacement about which those of the law lie, over its travel.

    The travel is limit over initial stiffness, which the first of its sliders make: of those of a wide spread
    it is far below the median. A friction of two stages, 282 N over 0.034 mm, was nearly one of 310 N over
    0.003 mm with a spread of 2.9, and the backbone nearest to that within 20 of its travels no start for it.
    """
    return float(np.median(yield_ratios(spread, IWAN_ELEMENTS))) if law == "lognormal" else 1.0


def _virgin(yields: FloatArray, distances: FloatArray) -> FloatArray:
    """(m, n) of sliders that yield at some distances, over the limit of each."""
    return np.asarray(np.minimum(distances[:, None] / yields, 1.0))


def _loading(
    law: FrictionLaw, exponent: float, spread: float, shares: Sequence[float], distances: FloatArray
) -> FloatArray:
    """(n,) force over the limit at distances over the travel."""
    if law == "backbone":
        return np.asarray(_virgin(np.array(BACKBONE_YIELDS), distances) @ np.array(shares) / np.sum(shares))
    if law == "iwan":
        return np.asarray(_virgin(iwan_yields(), distances).mean(axis=1))
    if law == "lognormal":
        return np.asarray(_virgin(yield_ratios(spread, IWAN_ELEMENTS), distances).mean(axis=1))
    return 1.0 - _rest(2.0 * distances, exponent if law == "duhem" else 1.0) / 2.0


def _rest(distances: FloatArray, exponent: float) -> FloatArray:
    """r = 1 - F / limit at some distances from the other limit: r' = -r^exponent, r(0) = 2."""
    over = exponent - 1.0
    if abs(over) < NEARLY_DAHL:
        return np.asarray(2.0 * np.exp(-distances))
    return np.asarray(np.maximum(2.0**-over + over * distances, 0.0) ** (-1.0 / over))
