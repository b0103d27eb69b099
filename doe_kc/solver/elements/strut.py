"""Strut rod in the tube (cylindrical joint) under the top-mount bushing."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.solver import rotation
from doe_kc.solver.builder import Builder, body, slide, twist
from doe_kc.solver.elements import bushing
from doe_kc.solver.elements._base import SIDES, Element, Stage, element, hardpoint, reflection
from doe_kc.solver.elements.knuckle import strut_axis


@element
class Strut(Element):
    """Body `rod.L`/`.R`, its origin in UPB; `slide.L`/`.R`: lengthening of LWD-UPB from design, mm."""

    id: ClassVar[str] = "strut"
    stage: ClassVar[Stage] = "body"
    rank: ClassVar[int] = 40

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            tube = b.bodies[f"tube.{side}"]
            top, axis = hardpoint(b, "UPB", side), strut_axis(b, side)
            along = tube.axes @ axis
            slid, slides = slide(f"strut slide {side}", along)
            turned, twists = twist(f"strut twist {side}", along)
            origin = tube.point(top) + along * slid
            rod = body(f"rod {side}", top, origin, rotation.compose(tube.gibbs, axis * turned))
            b.bodies[f"rod.{side}"] = b.join(f"strut {side}", rod, tube, slides + twists)
            b.points[f"slide.{side}"] = slid
            bushing.connect(b, "upb", side, at=top, axes=top_mount_axes(b, side), inner=None, outer=rod)


def top_mount_axes(b: Builder, side: str) -> ca.SX:
    """Local axes of the top mount: z along UPB -> UPBBI, x and y by the shortest turn from the chassis."""
    mirrored = reflection(side)
    along = mirrored @ (hardpoint(b, "UPBBI", side) - hardpoint(b, "UPB", side))
    turn = rotation.minimal_rotation_from_z(along / ca.norm_2(along))
    return b.constant(mirrored @ turn)
