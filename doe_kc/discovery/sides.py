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
    mirrored = np.array([-1.0 if v.parameter.mirrored else 1.0 for v in sided])
    return np.asarray((mirrored * right - left) * sd / 2.0)


def _sd(variable: Variable, value: float) -> float:
    quantity = variable.parameter.quantity
    fixed = {"clearance": SIDE_CLEARANCE, "coordinate": SIDE_POSITION, "angle": SIDE_ANGLE}
    return fixed.get(quantity, abs(value) * (SIDE_BUSHING if quantity == "stiffness" else SIDE_RATE))
