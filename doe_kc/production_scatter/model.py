"""The scatter of an axle's parameters: which deviate, by how much, and how alike their deviations are.

A deviation counts in the direction of the left side: of both sides alike it is what the plain path does, so
that y of a point on the right has the opposite sign in the chassis frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from doe_kc.axle.design_parameters import Parameter
from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.laws import DeviationLaw, normal_correlation


@dataclass(frozen=True, kw_only=True)
class Scatter:
    """Of one parameter. sd: standard deviation between cars, of either side, in its unit. common: share of
    the variance that left and right have in common; both_sides: whether there are two."""

    parameter: Parameter
    sd: float
    law: DeviationLaw
    common: float
    both_sides: bool

    @property
    def reach(self) -> float:
        """Largest deviation in the parameter's unit; inf for a law without end."""
        return self.sd * self.law.reach

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths that deviate: of each side, or of the whole axle."""
        path = self.parameter.path
        return (f"left.{path}", f"right.{path}") if self.both_sides else (path,)


@dataclass(frozen=True)
class ScatterModel:
    """m deviations of the paths of all `scatters`, in their order, left before right.

    nominal: (m,) values of the unchanged axle, in the chassis frame. sign: (m,) of a deviation's value there.
    correlation: (m, m) Pearson correlations of the deviations, positive semi-definite.
    """

    scatters: tuple[Scatter, ...]
    nominal: FloatArray
    sign: FloatArray
    correlation: FloatArray

    @cached_property
    def paths(self) -> tuple[str, ...]:
        """(m,) with side where there are two."""
        return tuple(path for s in self.scatters for path in s.paths)

    @cached_property
    def owner(self) -> np.ndarray:
        """(m,) place of each deviation's parameter among the scatters."""
        return np.repeat(np.arange(len(self.scatters)), [len(s.paths) for s in self.scatters])

    @cached_property
    def sd(self) -> FloatArray:
        """(m,) standard deviations."""
        return np.array([self.scatters[i].sd for i in self.owner])

    @cached_property
    def covariance(self) -> FloatArray:
        """(m, m) of the deviations."""
        return self.correlation * np.outer(self.sd, self.sd)

    @property
    def independent(self) -> bool:
        """Whether no two parameters' deviations correlate; the sides of one may."""
        other = self.owner[:, None] != self.owner
        return not np.any(self.correlation[other])

    def deviations(self, n: int, seed: int) -> FloatArray:
        """(n, m) of n cars; the first ones do not depend on n."""
        normal = np.random.default_rng(seed).standard_normal((n, len(self.paths))) @ self._root.T
        for k, i in enumerate(self.owner):
            normal[:, k] = self.scatters[i].sd * self.scatters[i].law.deviations(normal[:, k])
        return normal

    @cached_property
    def _root(self) -> FloatArray:
        """(m, m) of the correlations of the normal variables that the deviations are functions of."""
        values, vectors = np.linalg.eigh(self.normal_correlation)
        return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))

    @cached_property
    def normal_correlation(self) -> FloatArray:
        """(m, m); ValueError where two laws do not allow a correlation."""
        out = np.eye(len(self.paths))
        laws = [self.scatters[i].law for i in self.owner]
        for a, b in np.argwhere(np.triu(self.correlation, k=1)):
            out[a, b] = out[b, a] = normal_correlation(laws[a], laws[b], float(self.correlation[a, b]))
        return out

    def values(self, deviations: FloatArray) -> FloatArray:
        """(n, m) absolute values of the paths."""
        return self.nominal + self.sign * deviations

    def by_parameter(self, columns: FloatArray) -> FloatArray:
        """(p, ...) sums over the sides of rows (m, ...)."""
        out = np.zeros((len(self.scatters), *columns.shape[1:]))
        np.add.at(out, self.owner, columns)
        return out


def correlation_matrix(scatters: Sequence[Scatter], between: FloatArray) -> FloatArray:
    """(m, m) of all deviations from (p, p) between parameters on the same side.

    Across the sides: common of the parameter itself, sqrt(common_i common_j) times the correlation of two.
    """
    sides = [side for s in scatters for side in (("L", "R") if s.both_sides else ("",))]
    owner = [i for i, s in enumerate(scatters) for _ in s.paths]
    common = np.array([scatters[i].common for i in owner])
    across = np.array([[bool(a) and bool(b) and a != b for b in sides] for a in sides])
    same = between[np.ix_(owner, owner)]
    return np.asarray(np.where(across, same * np.sqrt(np.outer(common, common)), same))
