"""Objectives and constraints of the rating that characteristics contribute, and their expectations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import erf, ndtr

from doe_kc.ground.typing import FloatArray
from doe_kc.targets import LIMIT_WEIGHT, Constraint, Objective, Target

SCALAR_ROUNDING = 1e-3
"""Of Norm: width over which the corner of |e| is rounded for gradients."""
SHARP = 1e-7
"""Of Norm: standard deviation that stands for none."""
Triple = tuple[FloatArray, FloatArray, FloatArray]


@dataclass(frozen=True)
class ObjectiveTerms:
    """(k,) each; weights already divided by Norm and Norm^2.

    plain: +1 maximize, -1 minimize, 0 distance to the target.
    """

    target: FloatArray
    linear: FloatArray
    quadratic: FloatArray
    plain: FloatArray
    norm: FloatArray

    @classmethod
    def of(cls, targets: Sequence[Target]) -> ObjectiveTerms:
        """Zero weights where there is no objective."""
        filled = [t.objective or Objective(linear=0.0, quadratic=0.0) for t in targets]
        norm = np.array([o.norm for o in filled])
        return cls(
            np.array([t.value for t in targets]),
            np.array([o.linear for o in filled]) / norm,
            np.array([o.quadratic for o in filled]) / norm**2,
            np.array([0.0 if o.goal == "target" else o.sign for o in filled]),
            norm,
        )

    def value(self, y: FloatArray) -> FloatArray:
        """(p,) sum of the objective terms of equation 2.2 at y (p, k)."""
        e = y - self.target
        distance = -self.linear * np.abs(e) - self.quadratic * e**2
        return np.asarray(np.where(self.plain == 0.0, distance, self._plain_value(y)).sum(axis=-1))

    def slope(self, y: FloatArray) -> FloatArray:
        """(p, k) derivative, corners rounded."""
        e = y - self.target
        distance = (
            -self.linear * e / np.sqrt(e**2 + (SCALAR_ROUNDING * self.norm) ** 2) - 2.0 * self.quadratic * e
        )
        return np.asarray(np.where(self.plain == 0.0, distance, self._plain_slope(y)))

    def expected(self, y: FloatArray, variance: FloatArray) -> FloatArray:
        """(p,) expectation at Gaussian y (p, k) of variance (k,): folded normal distribution of |e|."""
        e, sd = y - self.target, np.sqrt(variance + (SHARP * self.norm) ** 2)
        z = np.clip(e / sd, -40.0, 40.0)
        folded = sd * np.sqrt(2.0 / np.pi) * np.exp(-0.5 * z**2) + e * erf(z / np.sqrt(2.0))
        distance = -self.linear * folded - self.quadratic * (e**2 + variance)
        return np.asarray(np.where(self.plain == 0.0, distance, self._plain_value(y)).sum(axis=-1))

    def majorizer(self, y: FloatArray, variance: FloatArray) -> Triple:
        """Curvature and gradient of -expected, and its derivative by the variance, (k,) each."""
        e, sd = y - self.target, np.sqrt(variance + (SHARP * self.norm) ** 2)
        width = np.sqrt(e**2 + 2.0 / np.pi * variance + (SCALAR_ROUNDING * self.norm) ** 2)
        curvature = self.linear / width + 2.0 * self.quadratic
        gradient = self.linear * erf(e / (sd * np.sqrt(2.0))) + 2.0 * self.quadratic * e
        z = np.clip(e / sd, -40.0, 40.0)
        density = np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi)
        by_variance = self.linear * density / np.maximum(sd, SCALAR_ROUNDING * self.norm) + self.quadratic
        plain = self.plain != 0.0
        return (
            np.where(plain, self.linear / self.norm, curvature),
            np.where(plain, -self._plain_slope(y), gradient),
            np.where(plain, 0.0, by_variance),
        )

    def _plain_value(self, y: FloatArray) -> FloatArray:
        return np.asarray(self.plain * (self.linear * y + self.quadratic * y**2))

    def _plain_slope(self, y: FloatArray) -> FloatArray:
        return np.asarray(self.plain * (self.linear + 2.0 * self.quadratic * y))


@dataclass(frozen=True)
class ConstraintTerms:
    """(k,) each; weights already divided by Norm and Norm^2, infinite intervals where there is none."""

    low: FloatArray
    high: FloatArray
    linear: FloatArray
    quadratic: FloatArray
    norm: FloatArray

    @classmethod
    def of(cls, targets: Sequence[Target]) -> ConstraintTerms:
        """Infinite intervals where there is no constraint."""
        free = Constraint(low=-np.inf, high=np.inf, linear=0.0, quadratic=0.0)
        filled = [t.constraint or free for t in targets]
        norm = np.array([c.norm for c in filled])
        return cls(
            np.array([c.low for c in filled]),
            np.array([c.high for c in filled]),
            np.array([c.linear for c in filled]) / norm,
            np.array([c.quadratic for c in filled]) / norm**2,
            norm,
        )

    @classmethod
    def limits(cls, targets: Sequence[Target]) -> ConstraintTerms:
        """The limits as constraints."""
        norm = np.array([t.scale for t in targets])
        weight = np.array([LIMIT_WEIGHT if np.isfinite(t.limit) else 0.0 for t in targets])
        return cls(
            np.array([t.value - t.threshold for t in targets]),
            np.array([t.value + t.threshold for t in targets]),
            np.zeros(norm.size),
            weight / norm**2,
            norm,
        )

    def value(self, y: FloatArray) -> FloatArray:
        """(p,) sum of the constraint terms of equation 2.2 at y (p, k)."""
        v = self._violation(y)
        return np.asarray(-(self.linear * np.abs(v) + self.quadratic * v**2).sum(axis=-1))

    def slope(self, y: FloatArray) -> FloatArray:
        """(p, k) derivative."""
        v = self._violation(y)
        return np.asarray(-self.linear * np.sign(v) - 2.0 * self.quadratic * v)

    def expected(self, y: FloatArray, variance: FloatArray) -> FloatArray:
        """(p,) expectation at Gaussian y (p, k) of variance (k,): both tails of the normal distribution."""
        sd = np.sqrt(variance + (SHARP * self.norm) ** 2)
        tails = [_tail(d / sd) for d in (y - self.high, self.low - y)]
        first = sum(t[1] for t in tails) * sd
        second = sum(t[2] for t in tails) * sd**2
        return np.asarray(-(self.linear * first + self.quadratic * second).sum(axis=-1))

    def majorizer(self, y: FloatArray, variance: FloatArray) -> Triple:
        """Curvature and gradient of -expected, and its derivative by the variance, (k,) each."""
        sd = np.sqrt(variance + (SHARP * self.norm) ** 2)
        above, below = _tail((y - self.high) / sd), _tail((self.low - y) / sd)
        outside = above[0] + below[0]
        push = self.linear * (above[0] - below[0]) + 2.0 * self.quadratic * sd * (above[1] - below[1])
        return 2.0 * self.quadratic * outside, push, self.quadratic * outside

    def _violation(self, y: FloatArray) -> FloatArray:
        """(..., k) signed: below the interval negative."""
        return np.asarray(np.maximum(y - self.high, 0.0) - np.maximum(self.low - y, 0.0))


def _tail(x: FloatArray) -> Triple:
    """P(z > -x), E[max(x + z, 0)] and E[max(x + z, 0)^2] of a standard normal z; 0 at x = -inf."""
    at = np.clip(x, -1e8, None)
    probability, density = ndtr(at), np.exp(-0.5 * np.minimum(at**2, 1e3)) / np.sqrt(2.0 * np.pi)
    first = at * probability + density
    second = (at**2 + 1.0) * probability + at * density
    return probability, np.maximum(first, 0.0), np.maximum(second, 0.0)
