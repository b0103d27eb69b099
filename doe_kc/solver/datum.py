"""What load cases take over from the static state: pad heights, wheel-centre heights, spring preload."""

from __future__ import annotations

import numpy as np

from doe_kc.solver.kernel import Kernel
from doe_kc.solver.load_cases import LoadCase, StaticPads
from doe_kc.solver.static import control_matrix
from doe_kc.typing import FloatArray

DATUM = ("pad L", "pad R", "wheel centre L", "wheel centre R", "preload")
"""mm, the last in N: rows of every derivative of the datum."""


def control_gradient(k: Kernel, case: LoadCase, inputs: FloatArray, pads: StaticPads) -> FloatArray:
    """(n, nu, 5) derivative of the controls at the inputs (n,) to the datum; they are affine in it."""
    base = _controls(k, case, inputs, pads)
    flat = [*pads.pad, *pads.wheel_centre_z, pads.preload]
    columns = []
    for i in range(len(flat)):
        moved = list(flat)
        moved[i] += 1.0
        shifted = StaticPads((moved[0], moved[1]), (moved[2], moved[3]), moved[4])
        columns.append(_controls(k, case, inputs, shifted) - base)
    return np.stack(columns, axis=-1)


def _controls(k: Kernel, case: LoadCase, inputs: FloatArray, pads: StaticPads) -> FloatArray:
    values = {"preload": pads.preload, **case.driven(inputs, pads)}
    return control_matrix(k, values, len(inputs))
