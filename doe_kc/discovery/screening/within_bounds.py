"""What each hypothesis would gain between the bounds, about the nominal axle.

Screening lets parameters that a bound holds back move as if they were free, about an axle that is bent as far
as its bounds let it: what re-tuning cannot reach then looks as if it could. A wrong ride height moves every
hardpoint, and looks like all of them at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.least_squares import bounded_step
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.thresholds import BENT_SHARE
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray


@dataclass(frozen=True)
class BoundedGain:
    """A hypothesis added to the model about the nominal axle, everything between its bounds."""

    screened: Screened
    """As it was screened."""
    gain: float
    """Half the decrease of the cost to first order, over that without it."""
    amplitudes: FloatArray
    """(m,) its sizes there, in typical ones."""


def many_held(current: Fit) -> bool:
    """Whether bounds hold back so many parameters that screening as if they were free means little."""
    return bool(np.mean(current.held[: current.model.parameters]) >= BENT_SHARE)


def nominal_fit(current: Fit) -> Fit:
    """The same model, not fitted: at the nominal axle, with its effects as they are. NotConverged when that
    has no equilibrium."""
    centre = current.model.centre[: current.model.dimension]
    return fit(current.model, np.concatenate([centre, current.amplitudes]), steps=0)


def gains_within_bounds(nominal: Fit, screened: Sequence[Screened]) -> list[BoundedGain]:
    """Of every hypothesis that has an equilibrium, the largest gain first. nominal: see `nominal_fit`."""
    without, _ = _decrease(nominal, np.zeros((nominal.residual.size, 0)), np.zeros(0), np.zeros(0))
    out = []
    for s in screened:
        if not s.failed:
            decrease, amplitudes = _decrease(nominal, _columns(s), *_size_bounds(nominal.model, s.hypothesis))
            own = amplitudes[: s.amplitudes.size]
            out.append(BoundedGain(s, decrease - without, own))
    return sorted(out, key=lambda g: -g.gain)


def _decrease(
    nominal: Fit, columns: FloatArray, low: FloatArray, high: FloatArray
) -> tuple[float, FloatArray]:
    """Half the decrease of the cost by the most probable step, and (k,) that of the columns (M, k)."""
    pulled, count, model = nominal.changes(columns).pulled, columns.shape[1], nominal.model
    hessian = np.block([[nominal.hessian, pulled], [pulled.T, columns.T @ columns + np.eye(count)]])
    gradient = np.concatenate([nominal.gradient, columns.T @ nominal.residual])
    below = np.concatenate([model.lower - nominal.z, low])
    above = np.concatenate([model.upper - nominal.z, high])
    step = bounded_step(hessian, gradient, below, above)
    return -float(gradient @ step + 0.5 * step @ hessian @ step), step[step.size - count :]


def _columns(screened: Screened) -> FloatArray:
    """(M, k) of its sizes; of an effect without any what it does, which is there or not.

    In one order of memory, whether from the cache or not: sums round by it, and a refit is known again by the
    digits that it begins with.
    """
    return np.ascontiguousarray(screened.columns if screened.amplitudes.size else screened.change[:, None])


def _size_bounds(model: EffectModel, hypothesis: Hypothesis) -> tuple[FloatArray, FloatArray]:
    """(k,) of the amplitudes, or of the share of an effect without sizes."""
    if not hypothesis.sizes:
        return np.zeros(1), np.ones(1)
    count, extended = model.lower.size, model.extended(hypothesis)
    return extended.lower[count:], extended.upper[count:]
