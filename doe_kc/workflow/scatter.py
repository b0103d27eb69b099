"""How production scatter of the axle's own parameters bends its vertical-motion curves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from doe_kc.axle import Axle, design_parameters
from doe_kc.curves import RIG_RESPONSES, TYRE_LOAD
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import mean_and_half_width, rising
from doe_kc.solver.result import Solution
from doe_kc.solver.sensitivity import sensitivities


def vertical_scatter(axle: Axle, solution: Solution) -> dict[str, FloatArray]:
    """Response -> (n, p) one-sigma changes of the left `vertical` curves on their rising input grid.

    Angles and wheel centre as change from static; columns: scattering parameters. From the exact
    sensitivities.
    """
    scattering = [p for p in design_parameters(axle) if p.production_sd > 0]
    case = solution.cases["vertical"]
    alone = replace(solution, cases={"vertical": case})
    exact = sensitivities(axle, alone, [p.path for p in scattering])
    mean, _ = mean_and_half_width(case, list(exact.branches["vertical"]))
    sigma = np.array([p.production_sd for p in scattering])
    zero = int(np.argmin(np.abs(rising(case))))
    out = {}
    for response in RIG_RESPONSES:
        curve = mean[:, solution.column(f"{response}@L")] * sigma
        out[response] = curve if response == TYRE_LOAD else curve - curve[zero]
    return out
