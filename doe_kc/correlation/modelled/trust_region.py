"""Trust region of a search: the box about the best design in which a model is believed, and its radius.

The radius shrinks where a proposal gained little of what the model promised and grows where it gained most
(A. R. Conn, N. I. M. Gould, P. L. Toint, Trust-Region Methods, 2000, chapter 6).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True, kw_only=True)
class RadiusRule:
    """How a method moves the radius; radii as shares of the bounds.

    first, smallest, largest: radii. shrinkage, growth: factors of it. poor, good: actual over predicted gain
    below which the region shrinks, above which it grows; a method without a prediction passes 1 or 0.
    floor: what happens below `smallest`: "stay" there, "restart" from `first`, or "end" the search.
    """

    first: float
    smallest: float
    largest: float
    shrinkage: float
    growth: float
    poor: float = 0.5
    good: float = 0.5
    floor: Literal["stay", "restart", "end"]


@dataclass(frozen=True)
class TrustRegion:
    """radius: half-width of the box, share of the bounds."""

    rule: RadiusRule
    radius: float

    @classmethod
    def first(cls, rule: RadiusRule) -> TrustRegion:
        """With the first radius of the rule."""
        return cls(rule, rule.first)

    @property
    def exhausted(self) -> bool:
        """Whether the radius is below the smallest, which only the rule "end" allows."""
        return self.radius < self.rule.smallest

    def after(self, ratio: float, *, length: float = np.inf) -> TrustRegion:
        """After a proposal that gained `ratio` of what was predicted.

        length: largest change of a variable, share of the bounds; a step inside the box shrinks to less.
        """
        rule, radius = self.rule, self.radius
        if ratio < rule.poor:
            radius = min(radius, length) * rule.shrinkage
        elif ratio > rule.good:
            radius = min(rule.largest, radius * rule.growth)
        if radius < rule.smallest and rule.floor != "end":
            radius = rule.first if rule.floor == "restart" else rule.smallest
        return TrustRegion(rule, radius)

    def box(self, centre: FloatArray, *, shrunk: int = 0) -> TrustBox:
        """The box about a design (d,), its radius shrunk so many times, to the smallest at least."""
        if not shrunk:
            return TrustBox.around(centre, self.radius)
        return TrustBox.around(centre, max(self.radius * self.rule.shrinkage**shrunk, self.rule.smallest))


@dataclass(frozen=True)
class TrustBox:
    """Where a proposal may lie. lower, upper: (d,) in [0, 1]."""

    lower: FloatArray
    upper: FloatArray

    @classmethod
    def around(cls, centre: FloatArray, radius: float) -> TrustBox:
        """`radius` either way, within the bounds."""
        return cls(np.maximum(centre - radius, 0.0), np.minimum(centre + radius, 1.0))

    def clip(self, points: FloatArray) -> FloatArray:
        """Points moved inside."""
        return np.clip(points, self.lower, self.upper)
