"""Where model and records disagree: raw, and beyond what any re-tuning could absorb."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cholesky

from doe_kc.discovery.projection import Changes, Projection
from doe_kc.discovery.screening.contrasts import Contrast, Contrasts
from doe_kc.discovery.thresholds import CONTRAST_SHARE, FALSE_ALARM_CHANCE, NOISE_DRAWS, NOISE_SIZE_DOUBT
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Map:
    """Where a model and the records disagree, contrast by contrast."""

    names: tuple[Contrast, ...]
    """(k,) the contrasts."""
    z: FloatArray
    """(k,) statistics, N(0, 1) each without disagreement, nan where re-tuning absorbs the contrast wholly."""
    noise: FloatArray
    """(draws,) largest |z| of maps that noise alone gives."""

    @cached_property
    def threshold(self) -> float:
        """Largest |z| that noise alone passes in 5 % of maps."""
        return float(np.quantile(self.noise, 1.0 - FALSE_ALARM_CHANCE))

    @property
    def chance(self) -> float:
        """How often noise alone gives a largest |z| as large as this map's."""
        return float(np.mean(self.noise >= self.largest))

    @property
    def largest(self) -> float:
        """Largest |z|."""
        return float(np.nanmax(np.abs(self.z)))

    @property
    def mean_square(self) -> float:
        """Mean of z^2; 1 is noise."""
        return float(np.nanmean(self.z**2))

    @property
    def agrees(self) -> bool:
        """Whether noise alone explains the whole map."""
        return self.largest <= self.threshold

    def worst(self, count: int) -> list[tuple[Contrast, float]]:
        """The largest disagreements beyond the threshold, largest first."""
        order = np.argsort(-np.nan_to_num(np.abs(self.z)))[:count]
        return [(self.names[i], float(self.z[i])) for i in order if abs(self.z[i]) > self.threshold]


def raw_map(contrasts: Contrasts, residual: FloatArray) -> Map:
    """The map of a residual (M,) as it is, in units of the records' noise."""
    return _map(contrasts, (contrasts.rows.T @ contrasts.rows).toarray(), contrasts.rows.T @ residual)


def residual_map(contrasts: Contrasts, residual: Changes, projection: Projection) -> Map:
    """The map of a fitted residual: what re-tuning cannot absorb."""
    return _map(contrasts, *projection.products(contrasts.rows, residual))


def _map(contrasts: Contrasts, gram: FloatArray, products: FloatArray) -> Map:
    """gram: (k, k) of the contrasts. products: (k,) of them with the residual."""
    gram = gram + NOISE_SIZE_DOUBT * np.diag(np.diag(gram))
    length = np.sqrt(np.diag(gram))
    seen = length**2 > CONTRAST_SHARE
    z = np.where(seen, products / np.where(seen, length, 1.0), np.nan)
    scale = length[seen]
    correlation = gram[np.ix_(seen, seen)] / np.outer(scale, scale)
    return Map(contrasts.names, z, _largest_by_noise(correlation))


def _largest_by_noise(correlation: FloatArray) -> FloatArray:
    """(draws,) largest |z| of maps of noise of a correlation (k, k), positive definite by the doubt in it."""
    root = cholesky(correlation, lower=True, check_finite=False)
    drawn = np.random.default_rng(11).standard_normal((NOISE_DRAWS, root.shape[0])) @ root.T
    return np.asarray(np.abs(drawn).max(axis=1))
