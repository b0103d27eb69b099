"""How the controls of load cases move with what they take over from the axle, and with the gain of their
input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import Datum, LoadCase
from doe_kc.solver.equilibria import Substeps
from doe_kc.solver.kernel import Kernel
from doe_kc.solver.static import control_matrix

DATUM = (
    *("pad L", "pad R", "wheel centre L", "wheel centre R", "preload"),
    *("half track", "rack per turn"),
    "input gain",
)
"""mm, the preload in N, the gain -: rows of every derivative of the datum."""
AT_REST = 5
"""So many of them, the first, are of the static state; the others are dimensions of the axle and what the
load case's own input is multiplied by."""
GAIN_STEP = 1e-4
"""-, step of the gain to either side. Controls are affine in it, but for the tangent of an angle."""


def control_gradient(k: Kernel, case: LoadCase, inputs: FloatArray, datum: Datum) -> FloatArray:
    """(n, nu, 8) derivative of the controls at the inputs (n,) to the datum; they are affine in all of it but
    the gain."""
    base = _controls(k, case, inputs, datum)
    flat = [*datum.pad, *datum.wheel_centre_z, datum.preload, datum.half_track, datum.rack_mm_per_rev]
    columns = []
    for i in range(len(flat)):
        moved = list(flat)
        moved[i] += 1.0
        shifted = Datum((moved[0], moved[1]), (moved[2], moved[3]), *moved[4:])
        columns.append(_controls(k, case, inputs, shifted) - base)
    more, less = (
        _controls(k, replace(case, gain=case.gain + step), inputs, datum) for step in (GAIN_STEP, -GAIN_STEP)
    )
    columns.append((more - less) / (2.0 * GAIN_STEP))
    return np.stack(columns, axis=-1)


def gradient_between(du: FloatArray, inside: Substeps) -> FloatArray:
    """(m, nu, .) derivative of the controls inside steps, linear between those at the ends, du (n, nu, .)."""
    share = inside.share[:, None, None]
    return np.asarray(du[inside.step] + share * (du[inside.step + 1] - du[inside.step]))


def _controls(k: Kernel, case: LoadCase, inputs: FloatArray, datum: Datum) -> FloatArray:
    values = {"preload": datum.preload, **case.driven(inputs, datum)}
    return control_matrix(k, values, len(inputs))
