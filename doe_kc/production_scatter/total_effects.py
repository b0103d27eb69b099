"""Total contributions: slopes, and what they miss, fitted to the Monte Carlo sample and taken apart.

The sample minus its first order is fitted by corrections of the slopes, squares of all deviations, and
products of the pairs that contribute most, by ridge regression whose penalty leaving one car out chooses. A
parameter's total share is the sum of Cov(term, y) / Var(y) over all terms that it is in; an interaction
counts for each of its partners, so that the shares may add up to more than 1. Of independent deviations they
are the total effects of Sobol (I. M. Sobol, Math. Comput. Simul. 55, 2001), by G. Li et al. (J. Phys. Chem. A
114(19), 2010) for correlated ones. Deviations are symmetric about 0, so that they do not correlate with
squares and products: the linear part is taken apart by its known covariance, without the sample's error.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.production_scatter.model import ScatterModel
from doe_kc.surrogate_models.ridge import fit_ridge

MOST_PAIRS = 150
"""Products of two deviations at most."""
CARS_A_TERM = 3
"""Cars for each term of the fit, from which pairs are added."""


@dataclass(frozen=True)
class TotalEffects:
    """shares: (p, k) of the parameters in the variance of each characteristic. unexplained: (k,) share of the
    variance that slopes and fit together miss, each car left out in turn: a bound on what the shares lack."""

    shares: FloatArray
    unexplained: FloatArray


@one_thread()
def total_effects(
    deviations: FloatArray, values: FloatArray, slopes: FloatArray, model: ScatterModel
) -> TotalEffects:
    """deviations: (n, m) of the model. values: (n, k). slopes: (k, m)."""
    standard = deviations / model.sd
    m = standard.shape[1]
    linear = slopes * model.sd
    pairs = _pairs(linear, values.std(axis=0), len(values))
    curved = np.hstack([standard**2 - 1.0, standard[:, pairs[:, 0]] * standard[:, pairs[:, 1]]])
    fit = fit_ridge(np.hstack([standard, curved]), values - standard @ linear.T)
    slope = linear + fit.slope[:, :m]
    curvature = fit.slope[:, m:]
    plane = slope * (slope @ model.correlation)
    centred = curved - curved.mean(axis=0)
    bent = curvature * (curvature @ (centred.T @ centred / len(values)))
    total = plane.sum(axis=1) + bent.sum(axis=1)
    variance = values.var(axis=0)
    shares = _collected(np.hstack([plane, bent]), pairs, model.owner, m)
    with np.errstate(divide="ignore", invalid="ignore"):
        unexplained = np.nan_to_num((fit.left_out**2).mean(axis=0) / variance)
        return TotalEffects(np.nan_to_num(shares / total), unexplained)


def _pairs(linear: FloatArray, spread: FloatArray, n: int) -> np.ndarray:
    """(q, 2) of the deviations whose product of shares in the standard deviation is largest in any
    characteristic."""
    m = linear.shape[1]
    count = int(min(MOST_PAIRS, max(0, n // CARS_A_TERM - 2 * m), m * (m - 1) // 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.nan_to_num(np.abs(linear) / spread[:, None], posinf=0.0)
    first, second = np.triu_indices(m, k=1)
    size = (share[:, first] * share[:, second]).max(axis=0)
    best = np.argsort(-size, kind="stable")[:count]
    return np.column_stack([first[best], second[best]])


def _collected(parts: FloatArray, pairs: np.ndarray, owner: np.ndarray, m: int) -> FloatArray:
    """(p, k): each term to its parameter, a product to both of its own, once where they are one."""
    out = np.zeros((int(owner.max()) + 1, len(parts)))
    for place, column in enumerate(parts.T):
        deviations = [place % m] if place < 2 * m else pairs[place - 2 * m]
        for i in {int(owner[k]) for k in deviations}:
            out[i] += column
    return out
