"""Checks that what the elements of a type file name is there, once, and on the right side."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from doe_kc.axle.structure import CHASSIS
from doe_kc.axle_types.schema import AxleTypeFile
from doe_kc.ground.errors import InputError, nearest

WHEEL_CENTRE_POINT = "WLC"
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
RESERVED = {
    *("tyre", "static", "steering", "scb", "arb", "damper", "bump_stop", "rebound_stop", "ride_height"),
    *("hub", "rack_mount", "subframe", "strut_friction", "steering_friction", "power_assist"),
    *("left", "right", "effects", "load_cases", "units", "follow", "name", "type", "schema", CHASSIS),
}
"""Names that an axle has whatever its type: no element may bear them."""


def check_axle_type(file: AxleTypeFile, source: str) -> None:
    """InputError for a name that is unknown, unused, used twice, reserved, or of the wrong side, for a rack
    that is not single, and for an axle without springs. source: name of the file."""
    _check_names(file, source)
    check_follow(file.follow, file.points, source)
    for use in _uses(file):
        _check_bodies(file, use, source)
        _check_points(file, use, source)
    _check_used(file, source)
    if file.carrier not in file.bodies:
        raise InputError(
            f"{source}: carrier = {file.carrier!r} is no body; known are {', '.join(file.bodies)}."
            f"{nearest(file.carrier, file.bodies)}"
        )
    if file.rack is not None:
        for rod in file.rack.rods:
            if rod not in file.rods:
                raise InputError(
                    f"{source}: [rack] rods names {rod!r}, which is no rod; known are {', '.join(file.rods)}."
                )
        if file.bodies[file.rack.body] != "single":
            raise InputError(f"{source}: [bodies] {file.rack.body} is the rack; expected it to be 'single'.")
    if not file.springs:
        raise InputError(f"{source}: [springs] is empty; expected at least one spring to carry the car.")


def check_follow(follow: Mapping[str, str], points: Collection[str], source: str) -> None:
    """InputError unless every point follows another of either side that follows none."""
    for follower, leader in follow.items():
        for point in (follower, leader):
            if point not in points:
                raise InputError(
                    f"{source}: follow names {point!r}, which is not a hardpoint.{nearest(point, points)}"
                )
        if leader in follow:
            raise InputError(
                f"{source}: follow: {follower} follows {leader}, which itself follows another point; "
                "let both follow the same."
            )


@dataclass(frozen=True)
class _Use:
    """What a table names. where: the table's key; single: one for both sides."""

    where: str
    bodies: tuple[str, ...]
    points: tuple[str, ...]
    single: bool = False


def _uses(file: AxleTypeFile) -> Iterator[_Use]:
    """Bodies and points that the elements name."""
    for name, bush in file.bushings.items():
        yield _Use(f"bushings.{name}", (bush.inner, bush.outer), (bush.at, *(bush.line or ())), bush.single)
    for name, ball in file.balls.items():
        yield _Use(f"balls.{name}", (ball.a, ball.b), (ball.at,), ball.single)
    for kind in ("rods", "cylindricals", "springs"):
        for name, line in getattr(file, kind).items():
            yield _Use(f"{kind}.{name}", (line.a, line.b), (line.at_a, line.at_b), line.single)
    if file.damper is not None:
        ends = file.damper
        yield _Use("damper", (ends.a, ends.b), (ends.at_a, ends.at_b), ends.single)
    if file.rack is not None:
        yield _Use("rack", (file.rack.body, file.rack.carrier), (file.rack.at,))
    if file.arb is not None:
        yield _Use("arb", (file.arb.body,), (file.arb.at,))
    if file.kingpin is not None:
        pin = file.kingpin
        yield _Use("kingpin", (pin.lower_body, pin.upper_body), (pin.lower, pin.upper))
    if file.subframe is not None:
        yield _Use("subframe", (file.subframe.body,), tuple(file.subframe.centre))
    if file.strut is not None:
        clamp = file.strut
        yield _Use("strut", (clamp.body, clamp.carrier), (clamp.at, *clamp.line))
    if file.steer_arm is not None:
        beam = file.steer_arm
        yield _Use("steer_arm", (beam.body, beam.carrier), (beam.root, beam.at))
    if file.lines:
        yield _Use("lines", (), tuple(at for pairs in file.lines.values() for pair in pairs for at in pair))
    if file.fixed_points:
        yield _Use("fixed_points", (), tuple(file.fixed_points))


def _check_names(file: AxleTypeFile, source: str) -> None:
    elements = [*file.bushings, *file.balls, *file.rods, *file.cylindricals, *file.springs]
    points = [*file.points, *file.single_points]
    for name in (*elements, *points, *file.bodies):
        if not NAME.fullmatch(name):
            raise InputError(
                f"{source}: {name!r} is no name; expected letters, digits and _, a letter first."
            )
    for name in (*elements, *points):
        if name in RESERVED and name not in file.springs:
            raise InputError(f"{source}: the name {name!r} is taken by every axle; choose another.")
    for names, what in (([*elements, *points], "elements or points"), (list(file.bodies), "bodies")):
        twice = [name for name, count in Counter(names).items() if count > 1]
        if twice:
            raise InputError(f"{source}: two {what} are named {twice[0]!r}; rename one.")
    if WHEEL_CENTRE_POINT not in file.points:
        raise InputError(f"{source}: [points] has no {WHEEL_CENTRE_POINT}, the wheel centre; add it.")
    if CHASSIS in file.bodies:
        raise InputError(f"{source}: [bodies] names {CHASSIS!r}, which is the vehicle body; remove it.")


def _check_bodies(file: AxleTypeFile, use: _Use, source: str) -> None:
    known = [CHASSIS, *file.bodies]
    for body in use.bodies:
        if body not in known:
            raise InputError(
                f"{source}: [{use.where}] names the body {body!r}; known are {', '.join(known)}."
                f"{nearest(body, known)}"
            )
        if use.single and file.bodies.get(body) == "side":
            raise InputError(
                f"{source}: [{use.where}] is single, but {body} is a body of either side; "
                "expected single bodies only."
            )
    if len(use.bodies) == 2 and use.bodies[0] == use.bodies[1] and use.where != "kingpin":
        raise InputError(f"{source}: [{use.where}] connects {use.bodies[0]} with itself; name two bodies.")


def _check_points(file: AxleTypeFile, use: _Use, source: str) -> None:
    known = file.single_points if use.single else file.points
    table = "single_points" if use.single else "points"
    for point in use.points:
        if point not in known:
            raise InputError(
                f"{source}: [{use.where}] names the point {point!r}, which is not in [{table}]; "
                f"add it there or correct the name.{nearest(point, known)}"
            )


def _check_used(file: AxleTypeFile, source: str) -> None:
    """Every body is connected, every point used."""
    uses = list(_uses(file))
    bodies = {body for use in uses if use.where not in ("kingpin", "arb", "subframe") for body in use.bodies}
    drawn = ("lines", "fixed_points")
    points = {at for use in uses if use.where not in drawn for at in use.points} | {WHEEL_CENTRE_POINT}
    for body in file.bodies:
        if body not in bodies:
            raise InputError(f"{source}: the body {body!r} is connected with nothing; connect or remove it.")
    for point in (*file.points, *file.single_points):
        if point not in points:
            raise InputError(f"{source}: the point {point!r} is used by no element; use or remove it.")
