"""Rack on the sub-frame, driven through the steering column's spring, perhaps in a sprung housing."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.solver.builder import Body, Builder, slide
from doe_kc.solver.elements._base import Element, Stage, element


@element
class Steering(Element):
    """Body `rack`; `rack`: its travel relative to its housing, mm; `column force`: on the rack, N."""

    id: ClassVar[str] = "steering"
    stage: ClassVar[Stage] = "body"
    rank: ClassVar[int] = 60

    def assemble(self, b: Builder) -> None:
        carrier = b.bodies["subframe.centre"]
        if b.topology.rack_mount:
            carrier, housing = _slider(b, "rack housing", carrier)
            b.resist("rack housing", b.constant(b.parameter("rack_mount.rate")) * housing)
        b.bodies["rack"], travel = _slider(b, "rack", carrier)
        column = b.constant(b.parameter("scb.Tz") * b.parameter("steering.column"))
        windup = column * (travel - b.control("rack"))
        b.resist("rack", windup)
        b.points["rack"] = travel
        b.points["column force"] = -windup


def _slider(b: Builder, name: str, carrier: Body) -> tuple[Body, ca.SX]:
    """Body that slides along the carrier's Y axis, and its travel in mm."""
    axis = carrier.axes[:, 1]
    travel, slides = slide(name, axis)
    moved = Body(name, carrier.design, carrier.origin + axis * travel, carrier.gibbs, carrier.axes)
    return b.join(name, moved, carrier, slides), travel
