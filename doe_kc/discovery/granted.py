"""What the shape of an effect's law leaves open, granted as a further error of the records.

An effect that is in the model follows a law of its own in the car: a compliance stiffens, a friction breaks
away more softly. Without this, the difference would be taken for another effect.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.linalg import cholesky

from doe_kc.correlation.likelihood import CurveData, Likelihood
from doe_kc.discovery.model import EffectModel
from doe_kc.measurement.noise import smooth_correlation
from doe_kc.typing import FloatArray

SHAPE = 0.1
"""Standard deviation of what a law makes of a curve, relative to the model's, apart from its scale."""
LENGTH = 0.5
"""Correlation length of that ratio over the input, as a fraction of its amplitude."""


def granted(model: EffectModel, likelihood: Likelihood, z: FloatArray) -> EffectModel:
    """The model, its records' errors those of `likelihood` and of the laws of its effects at a point."""
    bare = model
    for member in model.members:
        bare = bare.without(member)
    plain = replace(model, likelihood=likelihood)
    made = plain.residual(z) - replace(bare, likelihood=likelihood).residual(z[: model.dimension])
    curves = [_widened(curve, made[place]) for curve, place in likelihood.slices()]
    return replace(model, likelihood=replace(likelihood, curves=tuple(curves)))


def _widened(curve: CurveData, made: FloatArray) -> CurveData:
    """made: (n,) whitened change of the curve by the effects."""
    change = curve.root @ made
    relative = curve.input / np.abs(curve.input).max()
    centred = np.eye(curve.size) - 1.0 / curve.size
    ratio = SHAPE**2 * centred @ smooth_correlation(relative, LENGTH) @ centred
    covariance = curve.root @ curve.root.T + ratio * np.outer(change, change)
    return replace(curve, root=np.asarray(cholesky(covariance, lower=True)))
