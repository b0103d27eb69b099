"""The constraint interval around a target (thesis, equations 5.1 and 5.2)."""

from __future__ import annotations

import math

INTERVAL_SHARE = 0.15
FLOOR = 0.005


def constraint_interval(target: float) -> tuple[float, float]:
    """(low, high) = target -+ 0.15 sqrt(target^2 + 0.005), in the target's unit.

    Widens the relative interval of targets close to zero.
    """
    half = INTERVAL_SHARE * math.sqrt(target**2 + FLOOR)
    return target - half, target + half
