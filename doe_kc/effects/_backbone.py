"""The free backbone that does nearly what a dry friction does by a closed law.

A law of sliders obeys Masing's rule: a branch after a reversal is its virgin curve twice as large. Dahl's and
Duhem's do not; of theirs the branch from one limit to the other counts, half as large, as a rig runs over
such loops and sees little of a first loading. By it Dahl's law is an exponential backbone of half its travel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.axle.sliders import BACKBONE_YIELDS, IWAN_ELEMENTS, iwan_yields, yield_ratios
from doe_kc.axle.topology import NEARLY_DAHL, FrictionLaw
from doe_kc.ground.typing import FloatArray

DISTANCES = np.geomspace(0.05, 20.0, 80)
"""Over the typical yield displacement of the closed law, at which the curves are compared."""
TRAVEL_FACTORS = np.geomspace(0.25, 4.0, 33)
"""Travels of the backbone that are tried, over that yield displacement."""
UNUSED_SHARE = 0.005
"""-, of a slider that the closed law has no use for: none would hold the fit that begins there."""
PULL = 0.05
"""-, of a share to the usual one, where the curve says little: over the weight of one point of the curve."""


@dataclass(frozen=True)
class Backbone:
    """A free backbone over the numbers of a closed law."""

    limit: float
    """Over that of the law: less where the law reaches its own farther away than the curves go."""
    travel: float
    """Over that of the law."""
    shares: tuple[float, ...]
    """Of the sliders in the limit, of sum 1."""


def nearest_backbone(law: FrictionLaw, exponent: float, spread: float, usual: Sequence[float]) -> Backbone:
    """The backbone of least squares from the curve of a closed law.

    exponent: of duhem only; spread: of lognormal only. usual: shares where the curve says nothing.
    """
    typical = _typical_yield(law, spread)
    curve, share = _loading(law, exponent, spread, typical * DISTANCES), np.array(usual)
    trials = [(_shares(curve, factor, share), factor) for factor in TRAVEL_FACTORS.tolist()]
    (shares, _), factor = min(trials, key=lambda trial: trial[0][1])
    shares = np.maximum(shares, UNUSED_SHARE)
    return Backbone(float(shares.sum()), typical * factor, tuple((shares / shares.sum()).tolist()))


def _shares(curve: FloatArray, factor: float, usual: FloatArray) -> tuple[FloatArray, float]:
    """Shares of least squares, none below 0, and the norm of what they leave."""
    from scipy.optimize import nnls  # a quarter of a second, which no other command has a use for

    virgin = _virgin(factor * np.array(BACKBONE_YIELDS))
    shares, misfit = nnls(
        np.vstack([virgin, PULL * np.eye(usual.size)]), np.concatenate([curve, PULL * usual])
    )
    return shares, float(misfit)


def _typical_yield(law: FrictionLaw, spread: float) -> float:
    """Yield displacement about which those of the closed law lie, over its travel.

    The travel is limit over initial stiffness, which the first of its sliders make: of those of a wide spread
    it is far below the median. A friction of two stages, 282 N over 0.034 mm, was nearly one of 310 N over
    0.003 mm with a spread of 2.9, and the backbone nearest to that within 20 of its travels no start for it.
    """
    return float(np.median(yield_ratios(spread, IWAN_ELEMENTS))) if law == "lognormal" else 1.0


def _virgin(yields: FloatArray, distances: FloatArray = DISTANCES) -> FloatArray:
    """(80, n) of sliders that yield at some distances, over the limit of each."""
    return np.asarray(np.minimum(distances[:, None] / yields, 1.0))


def _loading(law: FrictionLaw, exponent: float, spread: float, distances: FloatArray) -> FloatArray:
    """(80,) force over the limit at distances over the travel."""
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
