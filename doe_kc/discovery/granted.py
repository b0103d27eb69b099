"""What the law of an effect leaves open, granted as a further error of the records.

An effect that is in the model follows a law of its own in the car: a compliance stiffens, a friction breaks
away more softly. Without this, the difference would be taken for another effect.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import cholesky

from doe_kc.correlation.likelihood import Branches, CurveData, Likelihood
from doe_kc.curves import TYRE_LOAD
from doe_kc.discovery.model import EffectModel
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.measurement.noise import smooth_correlation
from doe_kc.typing import FloatArray

SHAPE = 0.1
"""Standard deviation of what a law makes of a curve, relative to the model's."""
LENGTH = 0.5
"""Correlation length of that ratio over the input, as a fraction of its amplitude."""


@dataclass(frozen=True)
class _Made:
    """What one member makes: change of every curve (n,), and the largest of each response and branches.

    sticks: a friction, whose smaller loops hang on the shape of its law, so that each curve's scale is open
    too; an elastic law's scale is the same in every curve, which is what tells effects apart.
    """

    changes: tuple[FloatArray, ...]
    largest: Mapping[tuple[str, Branches], float]
    sticks: bool


def granted(model: EffectModel, likelihood: Likelihood, z: FloatArray) -> EffectModel:
    """The model, its records' errors those of `likelihood` and of the laws of its effects at a point."""
    plain = replace(model, likelihood=likelihood)
    residual = plain.residual(z)
    made = [_made(plain, member, place, residual, z) for member, place in plain.places()]
    curves = [_widened(curve, i, made) for i, curve in enumerate(likelihood.curves)]
    return replace(model, likelihood=replace(likelihood, curves=tuple(curves)))


def _made(model: EffectModel, member: Hypothesis, place: slice, residual: FloatArray, z: FloatArray) -> _Made:
    without = model.without(member)
    whitened = residual - without.residual(np.delete(z, np.r_[place]))
    changes = tuple(curve.root @ whitened[at] for curve, at in model.likelihood.slices())
    largest: dict[tuple[str, Branches], float] = {}
    for curve, change in zip(model.likelihood.curves, changes, strict=True):
        key = (curve.response, curve.branches)
        largest[key] = max(largest.get(key, 0.0), float(np.abs(change).max()))
    alone = replace(model, members=(member,))
    axle = alone.with_effects(np.concatenate([z[: model.dimension], z[place]]))
    return _Made(changes, largest, axle.topology.frictional)


def _widened(curve: CurveData, at: int, made: list[_Made]) -> CurveData:
    relative = curve.input / np.abs(curve.input).max()
    smooth = smooth_correlation(relative, LENGTH)
    centred = np.eye(curve.size) - 1.0 / curve.size
    covariance = curve.root @ curve.root.T
    for one in made:
        change = one.changes[at]
        ratio = smooth if one.sticks else centred @ smooth @ centred
        covariance = covariance + SHAPE**2 * ratio * np.outer(change, change)
        if one.sticks:
            level = SHAPE * one.largest[curve.response, curve.branches]
            left_open = level * (1.0 - relative**2 if curve.branches == "half_width" else relative)
            covariance = covariance + smooth * np.outer(left_open, left_open)
            if curve.response == TYRE_LOAD:
                covariance = covariance + level**2
    return replace(curve, root=np.asarray(cholesky(covariance, lower=True)))
