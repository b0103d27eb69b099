"""Strut rod in the tube (cylindrical joint) under the top-mount bushing."""

from __future__ import annotations

from typing import ClassVar

import casadi as ca

from doe_kc.curves import SIDES
from doe_kc.solver import rotation
from doe_kc.solver.builder import Builder, body
from doe_kc.solver.elements import bushing
from doe_kc.solver.elements._base import Element, Stage, element, hardpoint, reflection
from doe_kc.solver.elements._cuts import cut, push_pair, turn_pair
from doe_kc.solver.elements.knuckle import strut_axes, strut_axis
from doe_kc.solver.freedoms import slide, twist


@element
class Strut(Element):
    """Body `rod.L`/`.R`, its origin in UPB; `slide.L`/`.R`: lengthening of LWD-UPB from design, mm."""

    id: ClassVar[str] = "strut"
    stage: ClassVar[Stage] = "body"
    rank: ClassVar[int] = 40

    def assemble(self, b: Builder) -> None:
        for side in SIDES:
            top, axis = hardpoint(b, "UPB", side), strut_axis(b, side)
            tube, middle = b.bodies[f"tube.{side}"], [("LWD", side), ("UPB", side)]
            tube = cut(b, "rod|tube", side, tube, middle, strut_axes, ("x", "y", "rx", "ry"))
            along = tube.axes @ axis
            slid, slides = slide(f"strut slide {side}", along)
            turned, twists = twist(f"strut twist {side}", along)
            origin = tube.point(top) + along * slid
            rod = body(f"rod {side}", top, origin, rotation.compose(tube.gibbs, axis * turned))
            b.bodies[f"rod.{side}"] = b.join(f"strut {side}", rod, tube, slides + twists)
            b.points[f"slide.{side}"] = slid
            b.resist(f"strut slide {side}", push_pair(b, "rod|tube", "z", side, slid))
            b.resist(f"strut twist {side}", turn_pair(b, "rod|tube", "rz", side, 2 * ca.atan(turned)))
            bushing.connect(b, "upb", side, at=top, axes=top_mount_axes(b, side), inner=None, outer=rod)


def top_mount_axes(b: Builder, side: str) -> ca.SX:
    """Local axes of the top mount: z along UPB -> UPBBI, x and y by the shortest turn from the chassis."""
    mirrored = reflection(side)
    along = mirrored @ (hardpoint(b, "UPBBI", side) - hardpoint(b, "UPB", side))
    turn = rotation.minimal_rotation_from_z(along / ca.norm_2(along))
    return b.constant(mirrored @ turn)
