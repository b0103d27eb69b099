"""The rating as a function of modelled outputs: characteristics first, then scores of the whole curves.

Equation 2.2 is cheap once the outputs are known, so surrogates describe the outputs and the rating is
computed on their predictions: its value, its expectation under Gaussian errors of the prediction, exact
gradients, and a quadratic majorizer for Gauss-Newton steps (|e| <= e^2 / (2 a) + a / 2 with equality at
a = |e|; D. R. Hunter, K. Lange, A tutorial on MM algorithms, Am. Stat. 58(1), 2004).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.modelled.terms import ConstraintTerms, CurveTerms, ObjectiveTerms
from doe_kc.ground.typing import FloatArray
from doe_kc.targets import Targets


@dataclass(frozen=True)
class Majorizer:
    """Of minus the expected rating about an output: 1/2 dh'H dh + g'dh; H (m, m), g (m,).

    variance: (m,) its derivative by the outputs' variances.
    """

    hessian: FloatArray
    gradient: FloatArray
    variance: FloatArray


class Composite:
    """Rating of outputs h (p, m), m = k characteristics and q curve scores."""

    def __init__(self, targets: Targets, mean: FloatArray, basis: FloatArray) -> None:
        """mean: (N,) of the scaled curves; basis: (q, N) orthonormal rows."""
        self._k = len(targets.characteristics)
        self._objectives = ObjectiveTerms.of(targets.characteristics)
        self._constraints = ConstraintTerms.of(targets.characteristics)
        self._limits = ConstraintTerms.limits(targets.characteristics)
        self._curves = CurveTerms.of(targets, mean, basis)

    def rating(self, h: FloatArray) -> FloatArray:
        """(p,) equation 2.2."""
        y, s = h[:, : self._k], h[:, self._k :]
        scalar = self._objectives.value(y) + self._constraints.value(y) + self._limits.value(y)
        return np.asarray(scalar + self._curves.value(s))

    def rating_and_gradient(self, h: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(p,) rating and its (p, m) derivative, corners of the latter rounded within 1/1000 of Norm."""
        y, s = h[:, : self._k], h[:, self._k :]
        terms = (self._objectives, self._constraints, self._limits)
        scalar, push = sum(t.value(y) for t in terms), sum(t.slope(y) for t in terms)
        value, slope = self._curves.value_and_slope(s)
        return np.asarray(scalar + value), np.hstack([push, slope])

    def expected(self, mean: FloatArray, variance: FloatArray) -> FloatArray:
        """(p,) expected rating of Gaussian outputs, mean (p, m), variance (m,) or (p, m)."""
        y, s = mean[:, : self._k], mean[:, self._k :]
        vy, vs = variance[..., : self._k], variance[..., self._k :]
        scalar = self._objectives.expected(y, vy) + self._constraints.expected(y, vy)
        scalar = scalar + self._limits.expected(y, vy)
        return np.asarray(scalar + self._curves.expected(s, vs))

    def majorizer(self, mean: FloatArray, variance: FloatArray) -> Majorizer:
        """Of -expected(mean, variance)."""
        (y, s), (vy, vs) = self._parts(mean), self._parts(variance)
        terms = (self._objectives, self._constraints, self._limits)
        parts = [part.majorizer(y, vy) for part in terms]
        curvature, gradient, by_variance = (sum(p[i] for p in parts) for i in range(3))
        block, push, blur = self._curves.majorizer(s, vs)
        hessian = np.zeros((mean.size, mean.size))
        hessian[: self._k, : self._k] = np.diag(curvature)
        hessian[self._k :, self._k :] = block
        return Majorizer(hessian, np.concatenate([gradient, push]), np.concatenate([by_variance, blur]))

    def _parts(self, h: FloatArray) -> tuple[FloatArray, FloatArray]:
        return h[: self._k], h[self._k :]
