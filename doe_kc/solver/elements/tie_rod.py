"""Tie rod between RIB on the rack and ROB on the knuckle: rigid, or with free play in its ball joint.

Free play: F = k0 dl + k1 (s(dl - gap/2) - s(-dl - gap/2)), s(x) = (x + sqrt(x^2 + e^2)) / 2, with
k0 = 20 N/mm, k1 = 20000 N/mm and e = 2e-3 mm.
"""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.solver.builder import Builder
from doe_kc.solver.elements._base import SIDES, Element, Stage, element, hardpoint

CENTRING_STIFFNESS = 20.0
CONTACT_STIFFNESS = 20000.0
SMOOTHING = 2e-3


def free_play_force(dl: ca.SX, gap: ca.SX) -> ca.SX:
    """Tension in N at the lengthening dl in mm."""

    def ramp(x: ca.SX) -> ca.SX:
        return (x + ca.sqrt(x**2 + SMOOTHING**2)) / 2

    return CENTRING_STIFFNESS * dl + CONTACT_STIFFNESS * (ramp(dl - gap / 2) - ramp(-dl - gap / 2))


@element
class TieRod(Element):
    """`tie rod.L`/`.R`: tension in N; `tie rod pull.L`/`.R`: force on the rack."""

    id: ClassVar[str] = "tie_rod"
    stage: ClassVar[Stage] = "force"

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            arm, rack = b.bodies[f"steer arm.{side}"], b.bodies["rack"]
            outer, inner = hardpoint(b, "ROB", side), hardpoint(b, "RIB", side)
            design = b.constant(ca.norm_2(outer - inner))
            along = arm.point(outer) - rack.point(inner)
            length = ca.norm_2(along)
            plays = b.topology.free_play_left if side == "L" else b.topology.free_play_right
            label = f"tie rod {side}"
            if plays:
                tension = free_play_force(length - design, b.constant(b.parameter(f"tie_rod.gap@{side}")))
            else:
                tension = b.rigid(label, f"tie rod {side} (length)", length - design)
            b.points[f"tie rod.{side}"] = tension
            pull = tension * along / length
            b.push(arm, -pull, arm.point(outer))
            b.push(rack, pull, rack.point(inner))
            b.points[f"tie rod pull.{side}"] = pull
