"""Anti-roll bar: vertical forces F = k (z_L - z_R) at the drop links on the tubes.

k follows the fourth power of the outer radius, k = k_nominal (r / r_nominal)^4, the law of a solid round
bar k = G pi r^4 / (2 L a^2) with its lever a fixed by the nominal pair.
"""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.solver.builder import Builder
from doe_kc.solver.elements._base import SIDES, Element, Stage, element, hardpoint


@element
class AntiRollBar(Element):
    """Couples the two sides."""

    id: ClassVar[str] = "anti_roll_bar"
    stage: ClassVar[Stage] = "force"

    def assemble(self, b: Builder) -> None:
        ratio = b.parameter("arb.radius") / b.parameter("arb.nominal_radius")
        rate = b.constant(b.parameter("arb.rate") * ratio**4)
        tubes = [b.bodies[f"tube.{side}"] for side in SIDES]
        links = [t.point(hardpoint(b, "ARB", s)) for t, s in zip(tubes, SIDES, strict=True)]
        force = ca.vertcat(0, 0, rate * (links[0][2] - links[1][2]))
        b.push(tubes[0], -force, links[0])
        b.push(tubes[1], force, links[1])
