"""Distributions of a deviation: each a monotone function of a standard normal variable, of mean 0 and
standard deviation 1.

Because all are functions of normal variables, correlated deviations are drawn through a Gaussian copula;
`normal_correlation` is the correlation that the normal variables need for the deviations to have theirs
(A. Nataf, C. R. Acad. Sci. 225, 1962; P.-L. Liu, A. Der Kiureghian, Probab. Eng. Mech. 1(2), 1986).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, final

import numpy as np
from scipy.special import erf, ndtr, ndtri

from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.options import LawId

HERMITE_NODES = 100
"""Of the quadrature that a distribution is expanded with."""
HERMITE_TERMS = 60
"""Of that expansion: for a uniform distribution, the slowest, the last is below 1e-17."""
SURE = 1e-9
"""Distance from a correlation of one within which it is one."""


@dataclass(frozen=True)
class DeviationLaw(ABC):
    """limits: standard deviations of the normal distribution that a tolerance is."""

    id: ClassVar[LawId]
    label: ClassVar[str]
    limits: float

    @abstractmethod
    def deviations(self, normal: FloatArray) -> FloatArray:
        """Deviations of variance 1 of standard normal values, element by element."""

    @abstractmethod
    def sd_of(self, tolerance: float) -> float:
        """Standard deviation of the law with a tolerance, in the same unit."""

    @property
    @abstractmethod
    def reach(self) -> float:
        """Largest deviation in standard deviations; inf for one without end."""


@final
class NormalLaw(DeviationLaw):
    """N(0, 1); a tolerance is `limits` standard deviations and no limit."""

    id: ClassVar[LawId] = "normal"
    label: ClassVar[str] = "normal"

    def deviations(self, normal: FloatArray) -> FloatArray:
        return normal

    def sd_of(self, tolerance: float) -> float:
        return tolerance / self.limits

    @property
    def reach(self) -> float:
        return math.inf


@final
class TruncatedNormalLaw(DeviationLaw):
    """Normal, cut at -+`limits` of its standard deviations before the cut, scaled to variance 1."""

    id: ClassVar[LawId] = "truncated_normal"
    label: ClassVar[str] = "normal, cut"

    @property
    def _shrinkage(self) -> float:
        """Standard deviation after the cut over that before: sqrt(1 - 2 b phi(b) / (2 Phi(b) - 1))."""
        b = self.limits
        density = math.exp(-0.5 * b * b) / math.sqrt(2.0 * math.pi)
        return math.sqrt(1.0 - 2.0 * b * density / float(erf(b / math.sqrt(2.0))))

    def deviations(self, normal: FloatArray) -> FloatArray:
        low = float(ndtr(-self.limits))
        cut = ndtri(low + (1.0 - 2.0 * low) * ndtr(normal))
        return np.asarray(np.clip(cut, -self.limits, self.limits) / self._shrinkage)

    def sd_of(self, tolerance: float) -> float:
        return tolerance / self.limits * self._shrinkage

    @property
    def reach(self) -> float:
        return self.limits / self._shrinkage


@final
class UniformLaw(DeviationLaw):
    """Equally probable within the tolerance; `limits` says nothing."""

    id: ClassVar[LawId] = "uniform"
    label: ClassVar[str] = "uniform"

    def deviations(self, normal: FloatArray) -> FloatArray:
        return np.asarray((2.0 * ndtr(normal) - 1.0) * math.sqrt(3.0))

    def sd_of(self, tolerance: float) -> float:
        return tolerance / math.sqrt(3.0)

    @property
    def reach(self) -> float:
        return math.sqrt(3.0)


DEVIATION_LAWS: dict[LawId, type[DeviationLaw]] = {
    law.id: law for law in (NormalLaw, TruncatedNormalLaw, UniformLaw)
}
"""By the name that a study gives them."""


@lru_cache(maxsize=256)
def normal_correlation(first: DeviationLaw, second: DeviationLaw, value: float) -> float:
    """Correlation of two standard normal variables whose deviations by two laws have the correlation `value`.

    ValueError when no Gaussian copula reaches it: two laws of unlike shape are never wholly correlated.
    """
    if value == 0.0 or (isinstance(first, NormalLaw) and isinstance(second, NormalLaw)):
        return value
    sign, size = math.copysign(1.0, value), abs(value)
    if first == second and size > 1.0 - SURE:
        return sign
    powers = _expansion(first) * _expansion(second)
    highest = float(powers.sum())
    if size > highest:
        raise ValueError(f"at most {highest:.3f}")
    from scipy.optimize import brentq

    def excess(r: float) -> float:
        return float(powers @ r ** np.arange(HERMITE_TERMS)) - size

    return sign * float(brentq(excess, 0.0, 1.0, xtol=1e-12))


@lru_cache(maxsize=64)
def _expansion(law: DeviationLaw) -> FloatArray:
    """(HERMITE_TERMS,) coefficients on normalized Hermite polynomials h_k: E[f h_k]. Of two laws the
    deviations correlate by sum a_k b_k r^k (Mehler)."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(HERMITE_NODES)
    values = law.deviations(nodes) * weights / math.sqrt(2.0 * math.pi)
    out = np.zeros(HERMITE_TERMS)
    before, polynomial = np.zeros_like(nodes), np.ones_like(nodes)
    for k in range(HERMITE_TERMS):
        out[k] = values @ polynomial
        before, polynomial = polynomial, (nodes * polynomial - math.sqrt(k) * before) / math.sqrt(k + 1.0)
    return out
