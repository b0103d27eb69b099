"""Bump stop, rebound stop and damper gas force along the strut."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.curves import SIDES
from doe_kc.solver import curve
from doe_kc.solver.builder import Builder
from doe_kc.solver.elements._base import Element, Stage, element


@element
class Stops(Element):
    """Forces on the change of the length LWD-UPB beyond the clearances, factor times the stop's curve.

    `stop.L`/`.R`: force that lengthens the strut, N.
    """

    id: ClassVar[str] = "stops"
    stage: ClassVar[Stage] = "force"

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            slide = b.points[f"slide.{side}"]
            bump = stop_force(b, "bump_stop", b.topology.bump_points, side, -slide)
            rebound = stop_force(b, "rebound_stop", b.topology.rebound_points, side, slide)
            gas = b.constant(b.parameter(f"damper.gas_force@{side}"))
            b.resist(f"strut slide {side}", -(bump - rebound + gas))
            b.points[f"stop.{side}"] = bump - rebound


def stop_force(b: Builder, name: str, points: int, side: str, travel: ca.SX) -> ca.SX:
    """N of a side's bump or rebound stop at the travel (mm) towards it; >= 0."""
    law = curve.symbolic(b, f"{name}.table", points)
    clearance = b.constant(b.parameter(f"{name}.clearance@{side}"))
    factor = b.constant(b.parameter(f"{name}.factor@{side}"))
    contact = travel - clearance
    return ca.if_else(contact > 0, factor * law(ca.fmax(contact, 0)), 0)
