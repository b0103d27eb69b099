"""Terms of the rating over modelled outputs: those of characteristics and those of curve scores."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import erf, ndtr

from doe_kc.ground.typing import FloatArray
from doe_kc.targets import LIMIT_WEIGHT, Constraint, Objective, Target, Targets

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


CURVE_ROUNDING = 1e-3
"""RMS over Norm at which the corner of the root is rounded for gradients."""


@dataclass(frozen=True)
class CurveTerms:
    """(RMS / Norm)^2 of c curves at scores s: s'As + 2 b's + e.

    a: (c, q, q). b: (c, q). e: (c,). linear, quadratic: (c,) LinWt and QuadWt. limit: (c,) RMS / Norm from
    which a term costs LIMIT_WEIGHT times the square of what is beyond.
    """

    a: FloatArray
    b: FloatArray
    e: FloatArray
    linear: FloatArray
    quadratic: FloatArray
    limit: FloatArray

    @classmethod
    def of(cls, targets: Targets, mean: FloatArray, basis: FloatArray) -> CurveTerms:
        """Of curves = mean + scores basis, all scaled by Norm; the misfit is one more, its Norm the noise."""
        q, off, parts = len(basis), mean - targets.scaled_targets, targets.blocks
        count, records = len(parts), targets.misfit
        more = [] if records is None else [records.weight]
        return cls(
            np.array([basis[:, p] @ basis[:, p].T for p in parts]).reshape(count, q, q),
            np.array([basis[:, p] @ off[p] for p in parts]).reshape(count, q),
            np.array([off[p] @ off[p] for p in parts]),
            np.array([c.objective.linear for c in targets.curves] + [0.0 for _ in more]),
            np.array([c.objective.quadratic for c in targets.curves] + more),
            np.array([c.threshold / c.objective.norm for c in targets.curves] + [np.inf for _ in more]),
        )

    def squares(self, s: FloatArray) -> FloatArray:
        """(p, c) (RMS / Norm)^2 at scores (p, q)."""
        return self._squares(s, self._products(s))

    def _products(self, s: FloatArray) -> FloatArray:
        """(c, q, p) A s, by BLAS: einsum does not use it for three operands."""
        return np.asarray(self.a @ s.T)

    def _squares(self, s: FloatArray, products: FloatArray) -> FloatArray:
        out = np.einsum("cqp,pq->pc", products, s) + 2.0 * s @ self.b.T + self.e
        return np.asarray(np.maximum(out, 0.0))

    def value(self, s: FloatArray) -> FloatArray:
        """(p,) sum of the curves' terms of equation 2.2."""
        return self._value(self.squares(s))

    def value_and_slope(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """`value` and its derivative (p, q), which share the products."""
        products = self._products(s)
        square = self._squares(s, products)
        weight = self._weight(square)
        slope = -np.einsum("pc,cqp->pq", weight, products) - weight @ self.b
        return self._value(square), np.asarray(slope)

    def expected(self, s: FloatArray, variance: FloatArray) -> FloatArray:
        """(p,) terms at the expected squares, scores (p, q) with independent variances (q,) or (p, q)."""
        return self._value(self._blurred(s, variance))

    def majorizer(self, s: FloatArray, variance: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Hessian (q, q) and gradient (q,) of -expected, and its derivative by the variances (q,)."""
        square = self._blurred(s[None], variance)[0]
        weight = self._weight(square)
        push = self.a @ s + self.b
        by_variance = 0.5 * weight @ np.einsum("cii->ci", self.a)
        return np.einsum("c,cij->ij", weight, self.a), weight @ push, np.asarray(by_variance)

    def _value(self, square: FloatArray) -> FloatArray:
        """(p,) terms of squares (p, c)."""
        size = np.sqrt(square)
        beyond = np.maximum(size - self.limit, 0.0)
        return np.asarray(-size @ self.linear - square @ self.quadratic - LIMIT_WEIGHT * (beyond**2).sum(-1))

    def _weight(self, square: FloatArray) -> FloatArray:
        """(..., c) minus twice the derivative of the terms by the squares."""
        size = np.sqrt(square + CURVE_ROUNDING**2)
        beyond = np.maximum(size - self.limit, 0.0)
        return np.asarray((self.linear + 2.0 * LIMIT_WEIGHT * beyond) / size + 2.0 * self.quadratic)

    def _blurred(self, s: FloatArray, variance: FloatArray) -> FloatArray:
        return np.asarray(self.squares(s) + variance @ np.einsum("cii->ic", self.a))
