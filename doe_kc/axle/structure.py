"""Which bodies and connections an axle type has, by name: its topology as data.

Every element exists once a side, on bodies of that side (a single body serves both), unless it is single.
Points of a side are the left side's, mirrored in y for the right; those of `single_points` are as they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

CHASSIS = "body"
"""Name of the vehicle body, which stands still."""
CHASSIS_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""Local axes along the chassis's."""


KinematicJoint = Literal["ball", "rigid", "hinge_x", "hinge_y", "hinge_z", "none"]


@dataclass(frozen=True)
class BushingConnection:
    """Six-axis element at the point `at`; its local axes ride on `inner`.

    line: points (from, to) along which local z lies at design; None: the axes are `axes`. axes: (3, 3) as
    rows, its columns are local x, y, z in chassis components at design, of the left side. joint: what stands
    in for it in pure kinematics; hinge_y: turns about local y alone, none: the bushing.
    """

    name: str
    inner: str
    outer: str
    at: str
    single: bool = False
    line: tuple[str, str] | None = None
    axes: tuple[tuple[float, ...], ...] = CHASSIS_AXES
    joint: KinematicJoint = "ball"


@dataclass(frozen=True)
class BallConnection:
    """Ball joint of the bodies a and b at the point `at`. seat: what probes call the part that the ball sits
    in, empty: by its body's name."""

    name: str
    a: str
    b: str
    at: str
    single: bool = False
    seat: str = ""


@dataclass(frozen=True)
class LineConnection:
    """Connection along the line from the point `at_a` of body a to the point `at_b` of body b.

    A rod (constant length), a cylindrical joint (both bodies carry the line), a spring, or a damper with its
    stops."""

    name: str
    a: str
    at_a: str
    b: str
    at_b: str
    single: bool = False


@dataclass(frozen=True)
class RackConnection:
    """Rack that slides along the carrier's Y.

    at: point of either side, at the rack's ends. rods: names of the rods that it steers by.
    """

    body: str
    carrier: str
    at: str
    rods: tuple[str, ...]


@dataclass(frozen=True)
class BarConnection:
    """Anti-roll bar whose drop links sit on `body` of either side at the point `at`."""

    body: str
    at: str


@dataclass(frozen=True)
class KingpinLine:
    """Line from the point `lower` of one body to the point `upper` of another."""

    lower: str
    lower_body: str
    upper: str
    upper_body: str


@dataclass(frozen=True)
class SplitBody:
    """Body that effects may split into a centre part and two halves: a sub-frame.

    centre: points in whose mean, over both sides, the parts are joined.
    """

    body: str
    centre: tuple[str, ...]


@dataclass(frozen=True)
class StrutClamp:
    """Part that is clamped to its carrier at the point `at`, a damper tube: rigidly, or by springs.

    line: points (from, to) about which the springs twist, and across which they bend.
    """

    body: str
    carrier: str
    at: str
    line: tuple[str, str]


@dataclass(frozen=True)
class SteerArmBeam:
    """Part at the point `at` that is the end of a beam, clamped to its carrier at the point `root`: rigid, or
    elastic."""

    body: str
    carrier: str
    root: str
    at: str


@dataclass(frozen=True)
class Structure:
    """Bodies and connections of one axle type: what decides its equations.

    bodies: of either side, single_bodies: one for both. points, single_points: names of hardpoints.
    springs: the first carries the preload of the static state. carrier: body that the wheel is fixed to,
    at the point WLC. fixed_points: those of `points` that are no design parameters.
    """

    type: str
    bodies: tuple[str, ...]
    single_bodies: tuple[str, ...]
    points: tuple[str, ...]
    single_points: tuple[str, ...]
    carrier: str
    bushings: tuple[BushingConnection, ...] = ()
    balls: tuple[BallConnection, ...] = ()
    rods: tuple[LineConnection, ...] = ()
    cylindricals: tuple[LineConnection, ...] = ()
    springs: tuple[LineConnection, ...] = ()
    damper: LineConnection | None = None
    rack: RackConnection | None = None
    bar: BarConnection | None = None
    kingpin: KingpinLine | None = None
    subframe: SplitBody | None = None
    strut: StrutClamp | None = None
    steer_arm: SteerArmBeam | None = None
    fixed_points: tuple[str, ...] = ()

    def __hash__(self) -> int:
        """Of the type's name: a topology is looked up at every design, and few types share one."""
        return hash(self.type)

    @property
    def design_points(self) -> tuple[str, ...]:
        """Two-sided hardpoints that are design parameters."""
        return tuple(name for name in self.points if name not in self.fixed_points)

    def sides(self, *, single: bool) -> tuple[str, ...]:
        """Sides on which an element exists: L and R, or one that is of no side."""
        return ("",) if single else ("L", "R")

    def on_side(self, body: str, side: str) -> str:
        """Name of a body's instance on a side: `arm.L`, or the name itself of a single one."""
        return body if body == CHASSIS or body in self.single_bodies else f"{body}.{side}"

    def part_on_side(self, body: str, side: str) -> str:
        """The same, but of a body that may be split the half of that side: `subframe.L`."""
        halved = self.subframe is not None and body == self.subframe.body
        return f"{body}.{side}" if side and halved else self.on_side(body, side)

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of all bodies, one a side, and the halves of one that may be split."""
        halves = () if self.subframe is None else (self.subframe.body,)
        return (*self.single_bodies, *(f"{name}.{side}" for name in (*halves, *self.bodies) for side in "LR"))

    def places(self) -> Iterator[tuple[str, str]]:
        """(body, hardpoint) of all that connections and the wheel name; a point may be on several bodies."""
        yield self.carrier, "WLC"
        if (pin := self.kingpin) is not None:
            yield from ((pin.lower_body, pin.lower), (pin.upper_body, pin.upper))
        for ball in self.balls:
            yield from ((ball.a, ball.at), (ball.b, ball.at))
        for bush in self.bushings:
            yield from ((bush.outer, bush.at), (bush.inner, bush.at))
        damper = () if self.damper is None else (self.damper,)
        for line in (*self.rods, *self.cylindricals, *self.springs, *damper):
            yield from ((line.a, line.at_a), (line.b, line.at_b))
        if self.bar is not None:
            yield self.bar.body, self.bar.at
        if (clamp := self.strut) is not None:
            yield from ((clamp.carrier, clamp.at), (clamp.body, clamp.at))
        if (beam := self.steer_arm) is not None:
            yield from ((beam.carrier, beam.root), (beam.carrier, beam.at), (beam.body, beam.at))

    def joint_points(self, body: str, *, single: bool) -> tuple[str, ...]:
        """Hardpoints at which bushings and ball joints hold a body, each once."""
        joints = [(bush.at, bush.single, (bush.inner, bush.outer)) for bush in self.bushings]
        joints += [(ball.at, ball.single, (ball.a, ball.b)) for ball in self.balls]
        return tuple(dict.fromkeys(at for at, alone, on in joints if body in on and alone == single))

    def body_at(self, point: str) -> str:
        """The first moving body that carries a hardpoint; the vehicle body where none does."""
        return next((body for body, at in self.places() if at == point and body != CHASSIS), CHASSIS)

    def points_on(self, body: str) -> tuple[str, ...]:
        """Hardpoints on a body, each once."""
        return tuple(dict.fromkeys(at for name, at in self.places() if name == body))


def of_side(name: str, side: str) -> str:
    """Internal name of a side's own value: `spring.rate@L`; of no side the name itself."""
    return f"{name}@{side}" if side else name
