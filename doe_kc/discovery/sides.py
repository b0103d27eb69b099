"""Differences between the two sides of a car, which no parameter of both sides can take."""

from __future__ import annotations

import numpy as np

from doe_kc.axle.parameters import parameter_value
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import SIDE_ANGLE, SIDE_BUSHING, SIDE_CLEARANCE, SIDE_POSITION, SIDE_RATE
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import curve_gradients
from doe_kc.solver.sensitivity import sensitivities
from doe_kc.solver.suite import solve
from doe_kc.variables import Variable


def side_differences(model: EffectModel, z: FloatArray) -> FloatArray:
    """(M, k) derivative of the residual at a point to each parameter's right minus left, per its sd."""
    axle = model.axle_at(z)
    sided = [v for v in model.space.variables if f"{v.path}@R" in axle.values]
    paths = [f"{side}.{v.path}" for side in ("left", "right") for v in sided]
    solution = solve(axle)
    found = curve_gradients(axle, solution, paths, sensitivities(axle, solution, paths))
    columns = model.likelihood.jacobian(found, np.zeros((0, len(paths))))
    left, right = columns[:, : len(sided)], columns[:, len(sided) :]
    sd = np.array([_sd(v, parameter_value(axle, v.path)) for v in sided])
    # y of a hardpoint is given in the chassis frame, where the right side's is the left's mirror image
    mirrored = np.array([-1.0 if _lateral(v) else 1.0 for v in sided])
    return np.asarray((mirrored * right - left) * sd / 2.0)


def _lateral(variable: Variable) -> bool:
    return variable.parameter.group == "HARDPOINTS" and variable.path.endswith(".y")


def _sd(variable: Variable, value: float) -> float:
    if variable.path.endswith("clearance"):
        return SIDE_CLEARANCE
    if variable.parameter.group == "HARDPOINTS":
        return SIDE_POSITION
    if variable.unit == "deg":
        return SIDE_ANGLE
    return abs(value) * (SIDE_BUSHING if variable.parameter.group == "BUSHINGS" else SIDE_RATE)
