"""How production scatter of the axle's own parameters bends its vertical-motion curves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from doe_kc.axle import Axle, Parameter, design_parameters
from doe_kc.curves import RIG_RESPONSES, TYRE_LOAD
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import mean_and_half_width, rising
from doe_kc.solver.result import Solution
from doe_kc.solver.sensitivity import sensitivities

HARDPOINT_SD = 1.0
"""mm, one standard deviation of a coordinate between cars of one design."""
BUSHING_SD = 0.2
"""Of the stiffness factor."""
RATE_SD = 0.03
"""Of springs, tyres and the anti-roll bar."""
ANGLE_SD = 0.1
"""deg, static toe and camber."""
LEFT_OUT = ("ride_height", "bump_stop.clearance", "rebound_stop.clearance")
"""What is looked for, and what the search for it treats by itself."""


def one_sigma(parameter: Parameter) -> float:
    """Production scatter of a parameter, in its unit; 0 for one that does not scatter."""
    if parameter.path in LEFT_OUT or not parameter.active:
        return 0.0
    if parameter.group == "HARDPOINTS":
        return HARDPOINT_SD
    if parameter.group == "BUSHINGS":
        return BUSHING_SD * parameter.nominal
    return ANGLE_SD if parameter.unit == "deg" else RATE_SD * abs(parameter.nominal)


def vertical_scatter(axle: Axle, solution: Solution) -> dict[str, FloatArray]:
    """Response -> (n, p) one-sigma changes of the left `vertical` curves on their rising input grid.

    Angles and wheel centre as change from static; columns: scattering parameters. From the exact
    sensitivities.
    """
    scattering = [p for p in design_parameters(axle) if one_sigma(p) > 0]
    case = solution.cases["vertical"]
    alone = replace(solution, cases={"vertical": case})
    exact = sensitivities(axle, alone, [p.path for p in scattering])
    mean, _ = mean_and_half_width(case, list(exact.branches["vertical"]))
    sigma = np.array([one_sigma(p) for p in scattering])
    zero = int(np.argmin(np.abs(rising(case))))
    out = {}
    for response in RIG_RESPONSES:
        curve = mean[:, solution.column(f"{response}@L")] * sigma
        out[response] = curve if response == TYRE_LOAD else curve - curve[zero]
    return out
