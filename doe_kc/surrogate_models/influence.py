"""Influence as surrogates see it, beside the one-at-a-time influence of the true solver."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.study import column_peaks
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.variables import Space

SIGN_SHARE = 0.05
"""Share of a column's largest magnitude from which the sign of an entry counts."""


@dataclass(frozen=True)
class Agreement:
    """All (m,), over the variables, nan for a characteristic that nothing moves.

    correlation: of the two columns. same_sign: share of the strong entries that agree in sign.
    error: root mean square difference, percent of the column's largest magnitude.
    """

    correlation: FloatArray
    same_sign: FloatArray
    error: FloatArray


def nominal_point(space: Space) -> FloatArray:
    """(d,) the unchanged axle, moved to the bounds where it is beyond them."""
    return np.clip(space.unit({v.path: v.parameter.nominal for v in space.variables}), 0.0, 1.0)


def surrogate_changes(model: Fitted, space: Space) -> FloatArray:
    """(d, m) gradient of the model at the unchanged axle times each parameter's step."""
    point = nominal_point(space)
    steps = np.array([v.parameter.step for v in space.variables]) / space.slopes(point)
    return np.asarray(model.gradient(point[None])[0].T * steps[:, None])


def free_variables(space: Space) -> np.ndarray:
    """(d,) bool: variables that no other parameter follows, which one at a time moves alone too."""
    leaders = {tie.leader for tie in space.ties}
    return np.array([v.path not in leaders for v in space.variables])


def agreement(changes: FloatArray, reference: FloatArray) -> Agreement:
    """Of changes (d, m) with the reference's (d, m); rows where the reference is unknown are left out."""
    known = np.isfinite(reference).all(axis=1)
    ours, theirs = changes[known], reference[known]
    peaks = column_peaks(theirs)
    strong = np.abs(theirs) >= SIGN_SHARE * peaks
    with np.errstate(invalid="ignore", divide="ignore"):
        same = ((np.sign(ours) == np.sign(theirs)) & strong).sum(axis=0) / strong.sum(axis=0)
        a, b = ours - ours.mean(axis=0), theirs - theirs.mean(axis=0)
        correlation = (a * b).sum(axis=0) / np.sqrt((a**2).sum(axis=0) * (b**2).sum(axis=0))
        error = 100.0 * np.sqrt(np.square(ours - theirs).mean(axis=0)) / peaks
    return Agreement(correlation, same, error)
