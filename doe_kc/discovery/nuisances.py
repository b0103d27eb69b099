"""Nuisances of a fit: the calibration of the rig's inputs and the differences between the car's two sides.

The calibration of an input is one common scale of its load case: all responses share it, which is why it is
not among the errors of single curves. It is the same number as the effect `rig_input_gain`, only of the size
that a sound rig has: what is read at the input u is of the true input (1 + g) u. The differences between the
sides are what no parameter of both sides can take.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.thresholds import (
    INPUT_GAIN,
    SIDE_ANGLE,
    SIDE_BUSHING,
    SIDE_CLEARANCE,
    SIDE_POSITION,
    SIDE_RATE,
)
from doe_kc.effects.hypothesis import Size
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_gradient import curve_gradients
from doe_kc.solver.suite import solve
from doe_kc.variables import Space, Variable

INPUT_EFFECT = "rig_input_gain"
"""The effect that is a calibration of the rig, only larger than a sound rig has."""


def calibrated(axle: Axle, cases: Sequence[str], errors: FloatArray) -> Axle:
    """The axle, its load cases driven by their true inputs. errors: (k,) of `cases`, in INPUT_GAIN."""
    driven = {
        name: replace(axle.load_cases[name], gain=axle.load_cases[name].gain * (1.0 + INPUT_GAIN * float(e)))
        for name, e in zip(cases, errors, strict=True)
        if name in axle.load_cases
    }
    return replace(axle, load_cases={**axle.load_cases, **driven})


def input_gain_amplitude(size: Size) -> float:
    """Amplitude of `rig_input_gain` that does the same as a calibration off by one standard deviation."""
    return float(np.log1p(INPUT_GAIN) / np.log(size.typical))


def sided_variables(axle: Axle, space: Space) -> tuple[Variable, ...]:
    """Variables whose parameter either side has, in the order of the columns of `side_differences`."""
    return tuple(v for v in space.variables if f"{v.path}@R" in axle.values)


def side_differences(axle: Axle, space: Space, likelihood: Likelihood) -> FloatArray:
    """(M, k) derivative of the residual at an axle to each parameter's right minus left, per its sd."""
    sided = sided_variables(axle, space)
    paths = [f"{side}.{v.path}" for side in ("left", "right") for v in sided]
    solution = solve(axle)
    gradients = curve_gradients(axle, solution, paths)
    columns = likelihood.jacobian(gradients, np.zeros((0, len(paths))))
    left, right = columns[:, : len(sided)], columns[:, len(sided) :]
    left_sd, right_sd = np.array([[_sd(v, axle.values[f"{v.path}@{side}"]) for v in sided] for side in "LR"])
    # y of a hardpoint is given in the chassis frame, where the right side's is the left's mirror image
    mirrored = np.array([-1.0 if v.parameter.mirrored else 1.0 for v in sided])
    return np.asarray((mirrored * right * right_sd - left * left_sd) / 2.0)


def _sd(variable: Variable, value: float) -> float:
    """Standard deviation of a parameter's right minus left by the value on one side."""
    quantity = variable.parameter.quantity
    fixed = {"clearance": SIDE_CLEARANCE, "coordinate": SIDE_POSITION, "angle": SIDE_ANGLE}
    return fixed.get(quantity, abs(value) * (SIDE_BUSHING if quantity == "stiffness" else SIDE_RATE))
