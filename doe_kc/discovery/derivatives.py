"""Derivatives of a model's residual to parameters, calibrations and the sizes of its effects.

Exact to parameters and calibrations, and to the sizes of effects that move nothing but numbers of the axle;
to other sizes, those of faults of the rig, by differences.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.correlation.linearization import moved_paths, to_places, value_gradients
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import AMPLITUDE_STEP, DIRECTION_STEP, INPUT_GAIN
from doe_kc.effects import EFFECTS
from doe_kc.effects._base import reading_gains
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import CURVE_OUTPUTS, CurveGradients, gradients_of, scaled_gradients
from doe_kc.solver.result import NotConverged
from doe_kc.solver.sensitivity import sensitivities

GAIN_COLUMN = "input gain"
"""Name of the column of what the calibrations scale."""
Directions = Mapping[str, Mapping[str, float]]
"""Place in z of an amplitude, as text -> what it changes the axle's internal values by."""


def own_columns(model: EffectModel, z: FloatArray, residual: FloatArray) -> FloatArray:
    """(M, p + m) derivative of the residual to parameters, calibrations and amplitudes. residual: at z."""
    sound, out = model.axle_at(z), np.zeros((residual.size, model.linear.start + len(model.sizes)))
    axle, places = model.driven(sound, z), range(model.dimension, z.size)
    moves, slopes = directions(model, z, sound, places), model.space.slopes(z[: model.parameters])
    solution, pool = model.solutions(axle), model.solutions.pool
    gradients = value_gradients(axle, solution, model.space, moves, GAIN_COLUMN, pool)
    exact, tuned = _whitened(model, gradients, axle), model.parameters + len(model.space.ties)
    exact[:, :tuned] *= _path_ratios(model, z)
    out[:, : model.parameters] = to_places(exact[:, :tuned], model.space, slopes)
    for curve, place in model.likelihood.slices():  # each calibration moves its own load case alone
        at = model.calibrations.start + model.cases.index(curve.load_case)
        out[place, at] = INPUT_GAIN * sound.load_cases[curve.load_case].gain * exact[place, -1]
    out[:, model.linear.start :] = _with_differences(model, z, residual, places, moves, exact[:, tuned:-1])
    return out


def _path_ratios(model: EffectModel, z: FloatArray) -> FloatArray:
    """(p + ties,) value that a path is set to over that of the space: see `EffectModel.values_with`."""
    ratios = model.effect_ratios(model.with_effects(z))
    return np.array([ratios.get(path, 1.0) for path in moved_paths(model.space)])


def amplitude_columns(
    model: EffectModel, z: FloatArray, residual: FloatArray, places: Sequence[int]
) -> FloatArray:
    """(M, k) derivative of the residual to the amplitudes at some places (k,) in z. residual: at z."""
    sound, known = model.axle_at(z), np.zeros((residual.size, 0))
    moves = directions(model, z, sound, places)
    if moves:
        axle = model.driven(sound, z)
        solution = model.solutions(axle)
        exact = sensitivities(axle, solution, (), moves, outputs=CURVE_OUTPUTS, pool=model.solutions.pool)
        known = _whitened(model, gradients_of(solution, exact), axle)
    return _with_differences(model, z, residual, places, moves, known)


def directions(model: EffectModel, z: FloatArray, here: Axle, places: Sequence[int]) -> Directions:
    """What the amplitudes at some places change the internal values of the axle at z, `here`, by.

    Without those that change anything else, its equations or what the rig reads: their derivatives are
    differences. Of one that stands for none it is what a larger one changes them by: by differences each of
    these took a solution of the whole axle, 40 % of the time of all derivatives where a few sizes of effects
    are none.
    """
    out: dict[str, dict[str, float]] = {}
    rig = {i for h, p in model.places() if EFFECTS[h.effect].on_rig for i in range(p.start, p.stop)}
    for i, there in model.axles_beside(z, here, [i for i in places if i not in rig], DIRECTION_STEP):
        change = {
            name: (value - here.values[name]) / DIRECTION_STEP
            for name, value in there.values.items()
            if value != here.values.get(name)
        }
        same = there.topology == here.topology and there.load_cases == here.load_cases
        if same and change and there.values.keys() == here.values.keys():
            out[str(i)] = change
    return out


def amplitude_differences(
    model: EffectModel, z: FloatArray, residual: FloatArray, places: Sequence[int]
) -> FloatArray:
    """(M, k) derivative of the residual to the amplitudes at some places (k,) in z, from one step each.

    From one the other way where the axle has no equilibrium there, as at the end of its steering lock.
    NotConverged where it has none on that side either, or may not go there. residual: at z.
    """
    columns = []
    for i in places:
        step = AMPLITUDE_STEP if z[i] + AMPLITUDE_STEP <= model.upper[i] else -AMPLITUDE_STEP
        columns.append(_difference(model, z, residual, i, step))
    return np.array(columns).T.reshape(residual.size, -1)


def _difference(
    model: EffectModel, z: FloatArray, residual: FloatArray, place: int, step: float
) -> FloatArray:
    along = step * np.eye(z.size)[place]
    try:
        return np.asarray((model.residual(z + along) - residual) / step)
    except NotConverged:
        if not model.lower[place] <= z[place] - step <= model.upper[place]:
            raise
    return np.asarray((residual - model.residual(z - along)) / step)


def _with_differences(
    model: EffectModel,
    z: FloatArray,
    residual: FloatArray,
    places: Sequence[int],
    moves: Directions,
    known: FloatArray,
) -> FloatArray:
    """(M, k) derivative to the amplitudes at some places. known: of `moves`; the others' are differences."""
    exact = np.array([str(i) in moves for i in places], dtype=bool)
    if exact.all():
        return known
    out = np.empty((residual.size, exact.size))
    out[:, exact] = known
    out[:, ~exact] = amplitude_differences(model, z, residual, [i for i in places if str(i) not in moves])
    return out


def _whitened(model: EffectModel, gradients: CurveGradients, axle: Axle) -> FloatArray:
    """(M, p) derivatives of the residual. gradients: of the axle's curves."""
    read = scaled_gradients(gradients, reading_gains(axle))
    return model.likelihood.jacobian(read, np.zeros((0, len(read.paths))))
