"""Share of each output's variance over the box that a variable takes part in: total effects.

Reference: M. J. W. Jansen, Computer Physics Communications 117, 1999; A. Saltelli et al., Computer Physics
Communications 181(2), 2010, table 2.
"""

from __future__ import annotations

import warnings

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.variables import Space


def total_shares(model: Fitted, space: Space, *, points: int = 256, seed: int = 0) -> FloatArray:
    """(d, m) total-effect indices of the model under the variables' distributions, some 5 % of a share exact.

    points (d + 2) predictions. Interactions count for every partner, so that a column may sum to more than 1.
    """
    d = space.dimension
    from scipy.stats import qmc  # takes half a second

    sobol = qmc.Sobol(2 * d, rng=np.random.default_rng(seed))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of a number of points that is no power of two
        unit = np.clip(sobol.random(points), 1e-9, 1.0 - 1e-9)
    first, second = space.drawn(unit[:, :d]), space.drawn(unit[:, d:])
    base = model.predict(first)
    variance = np.concatenate([base, model.predict(second)]).var(axis=0)
    shares = np.zeros((d, base.shape[1]))
    for k in range(d):
        moved = first.copy()
        moved[:, k] = second[:, k]
        shares[k] = 0.5 * np.square(base - model.predict(moved)).mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(variance > 0.0, shares / variance, 0.0)
