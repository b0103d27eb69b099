"""SMT's EGO class asked for its next designs: one iteration at a time, silenced and typed."""

from __future__ import annotations

import contextlib
import io
import warnings
from dataclasses import dataclass

import numpy as np

from doe_kc.errors import InputError, RunError
from doe_kc.typing import FloatArray


@dataclass(frozen=True)
class Proposal:
    """point: (d,) in the unit cube. loss, loss_sd: what the surrogate expects there."""

    point: FloatArray
    loss: float
    loss_sd: float


def check_installed() -> None:
    """InputError with the remedy when SMT is missing."""
    try:
        import smt  # noqa: F401
    except ImportError:
        raise InputError(
            'method smt_ego needs SMT, which is not installed; run: pip install "doe-kc[smt]".'
        ) from None


def propose(points: FloatArray, losses: FloatArray, *, number: int, seed: int) -> list[Proposal]:
    """Next designs that EGO.optimize would run after `points` (n, d) with `losses` (n,) to be minimized.

    EGO as it is: KPLS and expected improvement with their defaults, several at once by the Kriging believer.
    One of its iterations is run on a function that only notes what it is asked for. Empty when its inner
    search fails. RunError when the surrogate cannot be trained.
    """
    from smt.applications import EGO
    from smt.design_space import DesignSpace
    from smt.surrogate_models import KPLS

    asked: list[FloatArray] = []

    def note(x: FloatArray) -> FloatArray:
        asked.extend(np.array(x, dtype=float))
        return np.zeros((len(x), 1))

    space = DesignSpace(np.tile([0.0, 1.0], (points.shape[1], 1)), seed=seed)
    surrogate = KPLS(design_space=space, print_global=False, seed=seed)
    ego = EGO(
        n_iter=1,
        criterion="EI",
        n_parallel=number,
        qEI="KB",
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
    known = {p.tobytes() for p in points}  # after a failed inner search EGO asks for the last ones again
    new = [np.clip(x, 0.0, 1.0) for x in asked if x.tobytes() not in known]
    return [_expected(ego.gpr, x) for x in new]


def _expected(surrogate: object, point: FloatArray) -> Proposal:
    loss = float(surrogate.predict_values(point[None])[0, 0])  # type: ignore[attr-defined]
    variance = float(surrogate.predict_variances(point[None])[0, 0])  # type: ignore[attr-defined]
    return Proposal(point, loss, float(np.sqrt(max(variance, 0.0))))
