"""Probes put into an axle while it is assembled; without `Topology.probes` nothing is put in."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import casadi as ca

from doe_kc.solver import rotation
from doe_kc.solver.builder import Body, Builder, Response
from doe_kc.solver.elements._base import DEG, hardpoint, reflection
from doe_kc.solver.probe import Probe

SHIFTS = ("x", "y", "z")
ROTATION_AXES = ("rx", "ry", "rz")
NM = 1000.0
"""N mm in a Nm."""


def side_axes(_: Builder, side: str) -> ca.SX:
    """(3, 3) chassis axes as columns, those of the right side mirrored."""
    return reflection(side or "L")


def turn_sign(side: str) -> int:
    """Factor on rotations and moments along mirrored axes, which makes them mirror images too."""
    return -1 if side == "R" else 1


def cut(
    b: Builder,
    interface: str,
    side: str,
    parent: Body,
    at: Sequence[tuple[str, str]],
    axes: Callable[[Builder, str], ca.SX] = side_axes,
    dofs: Sequence[str] = (*SHIFTS, *ROTATION_AXES),
) -> Body:
    """`parent`, or with probes a body fixed to it that probes dislocate.

    at: hardpoints by name and side; the body's origin is in their middle. axes: gives the dislocations'
    axes in the parent's as columns (3, 3), mirrored on the right.
    """
    if not b.topology.probes:
        return parent
    name, own = f"{interface} {side}", axes(b, side)

    def probes(letters: Sequence[str], unit: str, part: int, factor: float) -> ca.SX:
        """Vector of the probes in the parent's axes; they see what part of the wrench is handed on."""
        out = ca.SX.zeros(3)
        for i, dof in enumerate(letters):
            along = factor * own[:, i]

            def handed(along: ca.SX = along) -> ca.SX:
                return ca.dot(parent.axes @ along, b.wrenches[name][part])

            if dof in dofs:
                out += along * b.probe(Probe(interface, dof, "dislocation", side, unit), handed)
        return out

    design = sum((hardpoint(b, *each) for each in at), ca.SX.zeros(3)) / len(at)
    origin = parent.point(design + probes(SHIFTS, "mm", 0, 1.0))
    # moments in Nm; half a small rotation vector is its Gibbs vector
    turn = probes(ROTATION_AXES, "deg", 1, turn_sign(side) / NM) * NM / (2 * DEG)
    gibbs, turned = rotation.compose(parent.gibbs, turn), parent.axes @ rotation.matrix(turn)
    return b.join(name, Body(name, design, origin, gibbs, turned), parent, [])


def stretch(b: Builder, interface: str, dof: str, side: str, force: Response) -> ca.SX:
    """Dislocation in mm of a connection along a line; force: handed along it, N."""
    return b.probe(Probe(interface, dof, "dislocation", side, "mm"), force)


def push_pair(b: Builder, interface: str, dof: str, side: str, displacement: ca.SX) -> ca.SX:
    """Force in N against a displacement in mm."""
    return b.probe(Probe(interface, dof, "force pair", side, "N"), lambda: displacement)


def turn_pair(b: Builder, interface: str, dof: str, side: str, angle: ca.SX) -> ca.SX:
    """Moment in N mm against an angle in rad about an axis that is mirrored on the right."""
    sign = turn_sign(side)
    return sign * NM * b.probe(Probe(interface, dof, "force pair", side, "Nm"), lambda: sign * DEG * angle)
