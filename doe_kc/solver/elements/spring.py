"""Coil spring from LWS on the tube to UPS on the body: F = preload - k (l - l_design), compression +."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.curves import SIDES
from doe_kc.solver.builder import FORCE_SCALE, Builder
from doe_kc.solver.elements._base import Element, Stage, element, hardpoint


@element
class CoilSpring(Element):
    """`spring.L`/`.R`: compressive force in N; `preload`: force at design length, both sides."""

    id: ClassVar[str] = "spring"
    stage: ClassVar[Stage] = "force"

    def assemble(self, b: Builder) -> None:
        preload = b.tail_unknown("preload", "spring preload", FORCE_SCALE)
        b.points["preload"] = preload
        for side in SIDES:
            lower, upper = hardpoint(b, "LWS", side), hardpoint(b, "UPS", side)
            design = b.constant(ca.norm_2(upper - lower))
            rate = b.constant(b.parameter(f"spring.rate@{side}"))
            tube = b.bodies[f"tube.{side}"]
            seat = tube.point(lower)
            length = ca.norm_2(upper - seat)
            force = preload - rate * (length - design)
            b.push(tube, force * (seat - upper) / length, seat)
            b.points[f"spring.{side}"] = force
