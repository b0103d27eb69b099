"""Steer arm as a round steel beam, clamped at its root.

At its end: axial stiffness E A / L, transverse 3 E I / L^3 (Euler-Bernoulli cantilever), A = pi r^2,
I = pi r^4 / 4.
"""

from __future__ import annotations

import casadi as ca

from doe_kc.solver.builder import Body, Builder
from doe_kc.solver.elements._base import hardpoint
from doe_kc.solver.elements._sprung import sprung_ball

STEEL_MODULUS = 210e3
"""N/mm^2."""


def beam_stiffness(radius: ca.SX, length: ca.SX) -> tuple[ca.SX, ca.SX]:
    """(axial, transverse) stiffness of a round steel cantilever at its end, N/mm."""
    area, inertia = ca.pi * radius**2, ca.pi * radius**4 / 4
    return STEEL_MODULUS * area / length, 3 * STEEL_MODULUS * inertia / length**3


def beam_end(b: Builder, name: str, carrier: Body, root: str, at: str, side: str) -> Body:
    """Massless body at the hardpoint `at`, displaced in the carrier's axes; root: hardpoint of the clamp."""
    arm = hardpoint(b, at, side) - hardpoint(b, root, side)
    length = ca.norm_2(arm)
    axial, transverse = beam_stiffness(b.parameter(f"steer_arm.radius@{side}"), length)
    axis = b.constant(arm / length)
    axial, transverse = b.constant(axial), b.constant(transverse)

    def force(deflection: ca.SX) -> ca.SX:
        return transverse * deflection + (axial - transverse) * ca.dot(axis, deflection) * axis

    return sprung_ball(b, name, carrier, hardpoint(b, at, side), force)
