"""The rating as a function of modelled outputs: characteristics first, then scores of the whole curves.

Equation 2.2 is cheap once the outputs are known, so the surrogates describe the outputs and the rating is
computed on their predictions: value, exact gradient, and a quadratic majorizer for Gauss-Newton steps
(|e| <= e^2 / (2 a) + a / 2 with equality at a = |e|; D. R. Hunter, K. Lange, A tutorial on MM algorithms,
Am. Stat. 58(1), 2004).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.targets import Constraint, Objective, Targets
from doe_kc.typing import FloatArray

CORNER = 1e-3
"""Of Norm: width over which the corner of |e| is rounded for gradients."""


@dataclass(frozen=True)
class Block:
    """RMS / Norm of one curve over the scores s: sqrt(s'As + 2 b's + c)."""

    a: FloatArray
    b: FloatArray
    c: float
    linear: float
    quadratic: float

    def square(self, s: FloatArray) -> FloatArray:
        """(p,) (RMS / Norm)^2 at scores (p, q)."""
        out = ((s @ self.a) * s).sum(axis=1) + 2.0 * s @ self.b + self.c
        return np.asarray(np.maximum(out, 0.0))

    def slope(self, s: FloatArray) -> FloatArray:
        """(p, q) half the derivative of `square`."""
        return np.asarray(s @ self.a + self.b)


@dataclass(frozen=True)
class Quadratic:
    """Majorizer of -rating about an output h: 1/2 dh'H dh + g'dh; H (m, m), g (m,)."""

    hessian: FloatArray
    gradient: FloatArray


class Composite:
    """Rating of outputs h (p, m), m = k characteristics and q curve scores."""

    def __init__(self, targets: Targets, mean: FloatArray, basis: FloatArray) -> None:
        """mean: (N,) of the scaled curves; basis: (q, N) orthonormal rows."""
        self._k, self._q = len(targets.characteristics), len(basis)
        self._value = targets.values
        self._objective = _Terms.of([t.objective for t in targets.characteristics])
        self._constraint = _Bounds.of([t.constraint for t in targets.characteristics])
        self._blocks = list(_blocks(targets, mean, basis))

    def rating(self, h: FloatArray) -> FloatArray:
        """(p,) equation 2.2."""
        y, s = h[:, : self._k], h[:, self._k :]
        total = self._objective.value(y - self._value, y) + self._constraint.value(y)
        for block in self._blocks:
            square = block.square(s)
            total = total - block.linear * np.sqrt(square) - block.quadratic * square
        return np.asarray(total)

    def gradient(self, h: FloatArray) -> FloatArray:
        """(p, m) derivative of the rating, |e| rounded within a thousandth of Norm."""
        y, s = h[:, : self._k], h[:, self._k :]
        out = np.empty_like(h)
        out[:, : self._k] = self._objective.slope(y - self._value) + self._constraint.slope(y)
        curves = np.zeros_like(s)
        for block in self._blocks:
            size = np.sqrt(block.square(s) + CORNER**2)
            curves -= (block.linear / size + 2.0 * block.quadratic)[:, None] * block.slope(s)
        out[:, self._k :] = curves
        return out

    def majorizer(self, h: FloatArray, blur: FloatArray) -> Quadratic:
        """Of -rating at one output (m,); blur: (m,) standard deviations that round the corners."""
        y, s = h[: self._k], h[None, self._k :]
        curvature, gradient = self._objective.majorizer(y - self._value, blur[: self._k])
        more, push = self._constraint.majorizer(y)
        hessian = np.zeros((h.size, h.size))
        hessian[: self._k, : self._k] = np.diag(curvature + more)
        total = np.zeros(h.size)
        total[: self._k] = gradient + push
        spread = np.diag(blur[self._k :] ** 2)
        for block in self._blocks:
            size = np.sqrt(block.square(s)[0] + np.sum(block.a * spread) + CORNER**2)
            weight = block.linear / size + 2.0 * block.quadratic
            hessian[self._k :, self._k :] += weight * block.a
            total[self._k :] += weight * block.slope(s)[0]
        return Quadratic(hessian, total)


def _blocks(targets: Targets, mean: FloatArray, basis: FloatArray) -> list[Block]:
    off = mean - targets.scaled_targets
    return [
        Block(
            a=basis[:, part] @ basis[:, part].T,
            b=basis[:, part] @ off[part],
            c=float(off[part] @ off[part]),
            linear=curve.objective.linear,
            quadratic=curve.objective.quadratic,
        )
        for curve, part in zip(targets.curves, targets.blocks, strict=True)
    ]


@dataclass(frozen=True)
class _Terms:
    """Objectives of the characteristics, (k,) each; weights already divided by Norm and Norm^2.

    plain: +1 maximize, -1 minimize, 0 distance to the target.
    """

    linear: FloatArray
    quadratic: FloatArray
    plain: FloatArray
    norm: FloatArray

    @classmethod
    def of(cls, objectives: list[Objective | None]) -> _Terms:
        """Zero weights where there is none."""
        filled = [o or Objective(linear=0.0, quadratic=0.0) for o in objectives]
        norm = np.array([o.norm for o in filled])
        signs = [0.0 if o.goal == "target" else o.sign for o in filled]
        return cls(
            np.array([o.linear for o in filled]) / norm,
            np.array([o.quadratic for o in filled]) / norm**2,
            np.array(signs),
            norm,
        )

    def value(self, e: FloatArray, y: FloatArray) -> FloatArray:
        """(p,) sum of the objective terms; e = y - target, (p, k)."""
        distance = -self.linear * np.abs(e) - self.quadratic * e**2
        plain = self.plain * (self.linear * y + self.quadratic * y**2)
        return np.asarray(np.where(self.plain == 0.0, distance, plain).sum(axis=-1))

    def slope(self, e: FloatArray) -> FloatArray:
        """(p, k) derivative; plain goals take their quadratic part at the target."""
        rounded = np.sqrt(e**2 + (CORNER * self.norm) ** 2)
        distance = -self.linear * e / rounded - 2.0 * self.quadratic * e
        return np.asarray(np.where(self.plain == 0.0, distance, self.plain * self.linear))

    def majorizer(self, e: FloatArray, blur: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Curvature and gradient of -value, (k,); a plain goal pulls with one Norm's curvature."""
        size = np.sqrt(e**2 + blur**2 + (CORNER * self.norm) ** 2)
        curvature = np.where(
            self.plain == 0.0, self.linear / size + 2.0 * self.quadratic, self.linear / self.norm
        )
        gradient = np.where(self.plain == 0.0, curvature * e, -self.plain * self.linear)
        return curvature, gradient


@dataclass(frozen=True)
class _Bounds:
    """Constraints of the characteristics, (k,) each; infinite intervals where there is none."""

    low: FloatArray
    high: FloatArray
    linear: FloatArray
    quadratic: FloatArray

    @classmethod
    def of(cls, constraints: list[Constraint | None]) -> _Bounds:
        """Infinite intervals where there is none."""
        filled = [c or Constraint(low=-np.inf, high=np.inf, linear=0.0, quadratic=0.0) for c in constraints]
        norm = np.array([c.norm for c in filled])
        return cls(
            np.array([c.low for c in filled]),
            np.array([c.high for c in filled]),
            np.array([c.linear for c in filled]) / norm,
            np.array([c.quadratic for c in filled]) / norm**2,
        )

    def _violation(self, y: FloatArray) -> FloatArray:
        """(..., k) signed: below the interval negative."""
        return np.asarray(np.maximum(y - self.high, 0.0) - np.maximum(self.low - y, 0.0))

    def value(self, y: FloatArray) -> FloatArray:
        """(p,) sum of the constraint terms."""
        v = self._violation(y)
        return np.asarray(-(self.linear * np.abs(v) + self.quadratic * v**2).sum(axis=-1))

    def slope(self, y: FloatArray) -> FloatArray:
        """(p, k) derivative."""
        v = self._violation(y)
        return np.asarray(-self.linear * np.sign(v) - 2.0 * self.quadratic * v)

    def majorizer(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Curvature and gradient of -value, (k,), of the violated ones."""
        v = self._violation(y)
        curvature = np.where(v != 0.0, 2.0 * self.quadratic, 0.0)
        return curvature, self.linear * np.sign(v) + curvature * v
