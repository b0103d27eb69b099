"""Springs, damper with stops and friction, and anti-roll bar of a structure."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from doe_kc.axle.structure import LineConnection, Structure, of_side
from doe_kc.curves import SIDES
from doe_kc.solver.builder import FORCE_SCALE, LENGTH_SCALE, Body, Builder, Unknown
from doe_kc.solver.elements._base import hardpoint
from doe_kc.solver.elements._cuts import push_pair
from doe_kc.solver.elements.anti_roll_bar import add_anti_roll_bar
from doe_kc.solver.elements.friction import add_friction
from doe_kc.solver.elements.stops import stop_force
from doe_kc.solver.structure.words import joint_words


@dataclass(frozen=True)
class ForceLine:
    """Line between points of two bodies. shortening: of its length from design, mm; toward: unit vector from
    the first end to the second."""

    first: Body
    second: Body
    start: ca.SX
    end: ca.SX
    toward: ca.SX
    shortening: ca.SX

    def push_apart(self, b: Builder, force: ca.SX) -> None:
        """Force in N that drives the ends apart when positive."""
        b.push(self.second, force * self.toward, self.end)
        b.push(self.first, -force * self.toward, self.start)


@dataclass(frozen=True)
class ForceSlide:
    """The same along a free motion of a joint. freedom: its name."""

    freedom: str
    shortening: ca.SX

    def push_apart(self, b: Builder, force: ca.SX) -> None:
        """Force in N that lengthens when positive."""
        b.resist(self.freedom, -force)


def force_line(b: Builder, structure: Structure, line: LineConnection, side: str) -> ForceLine:
    """The line of a spring or damper."""
    first, second = (b.bodies[structure.part_on_side(body, side)] for body in (line.a, line.b))
    design_start, design_end = hardpoint(b, line.at_a, side), hardpoint(b, line.at_b, side)
    design = b.constant(ca.norm_2(design_end - design_start))
    start, end = first.point(design_start), second.point(design_end)
    length = ca.norm_2(end - start)
    return ForceLine(first, second, start, end, (end - start) / length, design - length)


def add_springs(b: Builder, structure: Structure) -> None:
    """`spring.SIDE`: compressive force in N of the first spring, which carries the preload."""
    preload = b.tail_unknown("preload", "spring preload", FORCE_SCALE)
    b.points["preload"] = preload
    for i, spring in enumerate(structure.springs):
        for side in structure.sides(single=spring.single):
            line = force_line(b, structure, spring, side)
            rate = b.constant(b.parameter(of_side(f"{spring.name}.rate", side)))
            force = (preload if i == 0 else 0) + rate * line.shortening
            line.push_apart(b, force)
            if i == 0:
                b.points[f"spring.{side}"] = force


def add_damper(b: Builder, structure: Structure) -> None:
    """`stop.SIDE`: force in N of bump less rebound stop; `shortening.SIDE`: of the damper from design, mm."""
    for side in SIDES:
        if structure.damper is None:
            b.points[f"stop.{side}"] = b.points[f"shortening.{side}"] = ca.SX(0)
            continue
        line = _damper_line(b, structure, structure.damper, side)
        bump = stop_force(b, "bump_stop", b.topology.bump_points, side, line.shortening)
        rebound = stop_force(b, "rebound_stop", b.topology.rebound_points, side, -line.shortening)
        gas = b.constant(b.parameter(f"damper.gas_force@{side}"))
        line.push_apart(b, bump - rebound + gas - _damper_pair(b, line, side))
        b.points[f"stop.{side}"], b.points[f"shortening.{side}"] = bump - rebound, line.shortening
        if b.topology.strut_friction != "none":
            _add_damper_friction(b, line, side)


def _damper_pair(b: Builder, line: ForceLine | ForceSlide, side: str) -> ca.SX:
    """Probe against the damper's lengthening; on a joint's slide that joint has one."""
    if isinstance(line, ForceSlide):
        return ca.SX(0)
    return push_pair(b, "damper", "along", side, -line.shortening)


def _damper_line(
    b: Builder, structure: Structure, damper: LineConnection, side: str
) -> ForceLine | ForceSlide:
    """The slide of a cylindrical joint that guides the damper, else its own line."""
    ends = {(damper.a, damper.at_a), (damper.b, damper.at_b)}
    for guide in structure.cylindricals:
        slid = b.points.get(f"slide {guide.name}.{side}")
        if slid is not None and ends == {(guide.a, guide.at_a), (guide.b, guide.at_b)}:
            return ForceSlide(joint_words(f"{guide.name} slide", side), -slid)
    return force_line(b, structure, damper, side)


def _add_damper_friction(b: Builder, line: ForceLine | ForceSlide, side: str) -> None:
    """The march watches the travel for reversals: it must be an unknown of its own."""
    law = b.topology.strut_friction
    if isinstance(line, ForceSlide):
        force = add_friction(b, line.freedom, law, -line.shortening, "strut_friction", side)
    else:
        name = f"damper slide {side}"
        travel = ca.SX.sym(name)
        row = travel - line.shortening
        b.multipliers.append((Unknown(name, f"damper {side} (length)", LENGTH_SCALE), travel, row))
        force = add_friction(b, name, law, travel, "strut_friction", side)
        line.push_apart(b, force)
    b.points[f"friction.strut.{side}"] = force


def add_rack_friction(b: Builder) -> None:
    """`friction.steering`: force in N against the rack's travel."""
    law = b.topology.steering_friction
    if law != "none":
        force = add_friction(b, "rack", law, b.points["rack"], "steering_friction", "")
        b.points["friction.steering"] = force


def add_bar(b: Builder, structure: Structure) -> None:
    """The anti-roll bar, where the type has one."""
    if structure.bar is None:
        return
    bodies = [b.bodies[structure.part_on_side(structure.bar.body, side)] for side in SIDES]
    add_anti_roll_bar(b, bodies, structure.bar.at)
