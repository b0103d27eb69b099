"""Bump and rebound stop: factor times the stop's curve, beyond the clearance."""

from __future__ import annotations

import casadi as ca

from doe_kc.solver import curve
from doe_kc.solver.builder import Builder


def stop_force(b: Builder, name: str, points: int, side: str, travel: ca.SX) -> ca.SX:
    """N of a side's bump or rebound stop at the travel (mm) towards it; >= 0."""
    law = curve.symbolic(b, f"{name}.table", points)
    clearance = b.constant(b.parameter(f"{name}.clearance@{side}"))
    factor = b.constant(b.parameter(f"{name}.factor@{side}"))
    contact = travel - clearance
    return ca.if_else(contact > 0, factor * law(ca.fmax(contact, 0)), 0)
