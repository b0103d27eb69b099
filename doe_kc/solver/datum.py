"""How the controls of load cases move with what they take over from the axle, and with the gain of their
input."""

from __future__ import annotations

from typing import Any

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
    base = np.array(
        [*datum.pad, *datum.wheel_centre_z, datum.preload, datum.half_track, datum.rack_mm_per_rev]
    )
    count = base.size
    moved = base + np.vstack([np.zeros(count), np.eye(count), np.zeros((2, count))])
    gains = np.array([*[case.gain] * (1 + count), case.gain + GAIN_STEP, case.gain - GAIN_STEP])
    controls = _controls(k, case, gains[:, None] * inputs, moved)
    further = (controls[-2:-1] - controls[-1:]) / (2.0 * GAIN_STEP)
    return np.ascontiguousarray(np.concatenate([controls[1:-2] - controls[:1], further]).transpose(1, 2, 0))


def gradient_between(du: FloatArray, inside: Substeps) -> FloatArray:
    """(m, nu, .) derivative of the controls inside steps, linear between those at the ends, du (n, nu, .)."""
    share = inside.share[:, None, None]
    return np.asarray(du[inside.step] + share * (du[inside.step + 1] - du[inside.step]))


def _controls(k: Kernel, case: LoadCase, inputs: FloatArray, datums: FloatArray) -> FloatArray:
    """(d, n, nu) at true inputs (d, n) and as many datums, (d, 7)."""
    left, right, left_centre, right_centre, preload, half_track, rack = datums.T[:, :, None]
    fields: tuple[Any, ...] = ((left, right), (left_centre, right_centre), preload, half_track, rack)
    values = {"preload": preload, **case.controls(inputs, Datum(*fields))}
    return control_matrix(k, values, inputs.shape[1], (len(inputs),))
