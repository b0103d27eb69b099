"""Steer arm from SAH to ROB: part of the rigid knuckle, or a round steel beam clamped at SAH.

At ROB: axial stiffness E A / L, transverse 3 E I / L^3 (Euler-Bernoulli cantilever), A = pi r^2,
I = pi r^4 / 4.
"""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.curves import SIDES
from doe_kc.solver.builder import Body, Builder
from doe_kc.solver.elements._base import Element, Stage, element, hardpoint
from doe_kc.solver.elements._cuts import SHIFTS, cut
from doe_kc.solver.elements._sprung import sprung_ball

STEEL_MODULUS = 210e3
"""N/mm^2."""


def beam_stiffness(radius: ca.SX, length: ca.SX) -> tuple[ca.SX, ca.SX]:
    """(axial, transverse) stiffness of a round steel cantilever at its end, N/mm."""
    area, inertia = ca.pi * radius**2, ca.pi * radius**4 / 4
    return STEEL_MODULUS * area / length, 3 * STEEL_MODULUS * inertia / length**3


@element
class SteerArm(Element):
    """Body `steer arm.L`/`.R`: carries the outer tie-rod ball."""

    id: ClassVar[str] = "steer_arm"
    stage: ClassVar[Stage] = "body"
    rank: ClassVar[int] = 60

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            knuckle = b.bodies[f"knuckle.{side}"]
            knuckle = cut(b, "steer arm|knuckle", side, knuckle, [("ROB", side)], dofs=SHIFTS)
            b.bodies[f"steer arm.{side}"] = _beam_end(b, knuckle, side) if b.topology.steer_arm else knuckle


def _beam_end(b: Builder, knuckle: Body, side: str) -> Body:
    """Massless body at ROB, displaced in the knuckle's axes."""
    arm = hardpoint(b, "ROB", side) - hardpoint(b, "SAH", side)
    length = ca.norm_2(arm)
    axial, transverse = beam_stiffness(b.parameter(f"steer_arm.radius@{side}"), length)
    axis = b.constant(arm / length)
    axial, transverse = b.constant(axial), b.constant(transverse)

    def force(deflection: ca.SX) -> ca.SX:
        return transverse * deflection + (axial - transverse) * ca.dot(axis, deflection) * axis

    return sprung_ball(b, f"steer arm {side}", knuckle, hardpoint(b, "ROB", side), force)
