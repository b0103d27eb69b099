"""Share of each output's variance over the box that a variable takes part in: total effects.

Reference: M. J. W. Jansen, Computer Physics Communications 117, 1999; A. Saltelli et al., Computer Physics
Communications 181(2), 2010, table 2.
"""

from __future__ import annotations

import warnings
from functools import partial

import numpy as np

from doe_kc.campaign.executors import processes
from doe_kc.campaign.processes import available_cores
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.variables import Space


def total_shares(
    model: Fitted, space: Space, *, points: int = 256, seed: int = 0, workers: int | None = None
) -> FloatArray:
    """(d, m) total-effect indices of the model under the variables' distributions, some 5 % of a share exact.

    points (d + 2) predictions. Interactions count for every partner, so that a column may sum to more than 1.
    workers: processes, default one a core.
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
    count = min(workers or available_cores(), d)
    parts = [partial(_moved_squares, model, base, first, second, k) for k in np.array_split(range(d), count)]
    if count == 1:
        squares = [part() for part in parts]
    else:
        with processes(count) as executor:
            squares = [future.result() for future in [executor.submit(part) for part in parts]]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(variance > 0.0, 0.5 * np.concatenate(squares) / variance, 0.0)


def _moved_squares(
    model: Fitted, base: FloatArray, first: FloatArray, second: FloatArray, variables: np.ndarray
) -> FloatArray:
    """(k, m) mean squares of the changes when one variable takes its values of the second points."""
    squares = np.zeros((len(variables), base.shape[1]))
    for row, k in enumerate(variables):
        moved = first.copy()
        moved[:, k] = second[:, k]
        squares[row] = np.square(base - model.predict(moved)).mean(axis=0)
    return squares
