"""Curve objectives of the rating over the scores of the curves' principal components."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.targets import LIMIT_WEIGHT, Targets

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
