"""How far production scatter alone moves the vertical-motion curves of two axles of one design."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from doe_kc.ground.typing import FloatArray

KINEMATIC_SCATTER: Mapping[str, tuple[float, float, float]] = {
    "toe": (2.6e-3, 1.2e-6, 1.0e-8),
    "camber": (4.0e-4, 1.2e-6, 6.0e-9),
    "spin": (3.5e-4, 8.0e-7, 3.0e-9),
    "wc_x": (5.6e-3, 6.0e-6, 3.0e-8),
    "wc_y": (2.6e-3, 2.5e-6, 5.0e-9),
}
"""Response -> sd of the coefficients of z, z², z³ (deg or mm per mm, mm², mm³; z = wheel travel).

McPherson axle, hardpoints scattered by 1 mm per coordinate: a 350 mm lower arm tilts by 1/350 per mm,
which is the track slope; the others follow from solved variants of the reference axle.
"""

LOAD_OFFSET = 500.0
"""sd of the static tyre load, N: loading and preload differ from car to car and tell no ride height."""
RATE_SCATTER = 0.03
"""sd of the ride rate, fraction: springs, tyres, lever ratio."""
RATE_CURVATURE = 3e-3
"""sd of the coefficient of u² of the tyre load, N/mm²."""
STOP_SCATTER = 0.10
"""sd of a stop's force at given compression, fraction."""


def kinematic_modes(response: str, travel: FloatArray) -> FloatArray:
    """(n, 3) one-sigma changes of a kinematic curve over wheel travel (n,), zero at static."""
    powers: FloatArray = travel[:, None] ** np.arange(1, 4) * np.array(KINEMATIC_SCATTER[response])
    return powers


def load_modes(
    pad: FloatArray,
    rate: float,
    stops: FloatArray,
    stop_rate: FloatArray,
    *,
    bump: NDArray[np.bool_],
    stop_clearance_sd: float,
) -> FloatArray:
    """(n, 7) one-sigma changes of the tyre load over pad travel (n,), mm.

    Columns: static load, ride rate, its growth, force of bump and of rebound stop, their clearances.
    rate: N/mm at static. stops, stop_rate: (n,) force of the stops, N, and its slope, N/mm.
    bump: (n,) bool, on the bump side of the model's static state. stop_clearance_sd: mm at the wheel.
    """
    columns = [
        np.full(pad.size, LOAD_OFFSET),
        RATE_SCATTER * rate * pad,
        RATE_CURVATURE * pad**2,
        *(STOP_SCATTER * stops * side for side in (bump, ~bump)),
        *(stop_clearance_sd * stop_rate * side for side in (bump, ~bump)),
    ]
    return np.stack(columns, axis=1)
