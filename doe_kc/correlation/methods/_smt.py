"""SMT's EGO class asked for its next designs: one iteration at a time, silenced and typed."""

from __future__ import annotations

import contextlib
import io
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class Proposal:
    """point: (d,) in the unit cube. loss, loss_sd: what the surrogate expects there."""

    point: FloatArray
    loss: float
    loss_sd: float


def propose(points: FloatArray, losses: FloatArray, *, number: int, seed: int) -> list[Proposal]:
    """Next designs that EGO.optimize would run after `points` (n, d) with `losses` (n,) to be minimized.

    EGO as it is: KPLS and expected improvement with their defaults, also of several at once.
    One of its iterations is run on a function that only notes what it is asked for. Empty when its inner
    search fails. RunError when the surrogate cannot be trained.
    """
    from smt import applications, design_space, surrogate_models

    library: Any = applications
    models: Any = surrogate_models
    asked: list[FloatArray] = []

    def note(x: FloatArray) -> FloatArray:
        asked.extend(np.array(x, dtype=float))
        return np.zeros((len(x), 1))

    space = design_space.DesignSpace(np.tile([0.0, 1.0], (points.shape[1], 1)), seed=seed)
    surrogate = models.KPLS(design_space=space, print_global=False, seed=seed)
    ego = library.EGO(
        n_iter=1,
        criterion="EI",
        n_parallel=number,
        xdoe=points.copy(),
        ydoe=losses[:, None].copy(),
        surrogate=surrogate,
        seed=seed,
    )
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of SLSQP at the bounds
        try:
            ego.optimize(note)
        except (ValueError, np.linalg.LinAlgError) as error:
            raise RunError(f"SMT's EGO could not be trained on {len(points)} designs ({error}).") from None
    return [_expected(ego.gpr, np.clip(x, 0.0, 1.0)) for x in _without_repeats(asked, points)]


def _without_repeats(asked: list[FloatArray], points: FloatArray) -> list[FloatArray]:
    """After a failed inner search EGO asks for the last known designs again, before the new ones."""
    for repeated in range(min(len(asked), len(points)), 0, -1):
        if np.array_equal(np.array(asked[:repeated]), points[-repeated:]):
            return asked[repeated:]
    return asked


def _expected(surrogate: Any, point: FloatArray) -> Proposal:
    loss = float(surrogate.predict_values(point[None])[0, 0])
    variance = float(surrogate.predict_variances(point[None])[0, 0])
    return Proposal(point, loss, float(np.sqrt(max(variance, 0.0))))
