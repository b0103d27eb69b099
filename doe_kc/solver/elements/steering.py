"""Rack on its carrier, driven through the steering column's spring, perhaps in a sprung housing.

Power assist pushes the rack the way the column does, and the more the column is wound up: with the column's
own force S = k w the rack receives S (1 + g s^2 / (1 + s^2)), s = S / S_0. So S_0 is the force at which
half of the largest assistance g is there.
"""

from __future__ import annotations

import casadi as ca

from doe_kc.solver.builder import Body, Builder
from doe_kc.solver.elements._cuts import cut, push_pair, stretch
from doe_kc.solver.freedoms import slide


def add_rack(b: Builder, carrier: Body, at: str, carrier_noun: str) -> Body:
    """The rack on its carrier, which probes call `carrier_noun`; at: hardpoint of either side at its ends.

    Points `rack`: travel relative to the housing, mm; `column force`: on the rack, N."""
    carrier = cut(b, f"rack housing|{carrier_noun}", "", carrier, [(at, "L"), (at, "R")])
    if b.topology.rack_mount:
        carrier, housing = _slider(b, "rack housing", carrier)
        b.resist("rack housing", _mount(b, housing))
    rack, travel = _slider(b, "rack", carrier)
    column = b.constant(b.parameter("scb.Tz") * b.parameter("steering.column"))
    angle = travel - b.control("rack")
    own: list[ca.SX] = []
    own.append(column * (angle - stretch(b, "column", "along", "", lambda: own[0])))
    windup = own[0] + push_pair(b, "column", "along", "", angle)
    if b.topology.power_assist:
        windup *= 1 + _assistance(b, windup)
    b.resist("rack", windup + push_pair(b, "rack|housing", "along", "", travel))
    b.points["rack"] = travel
    b.points["column force"] = -windup
    return rack


def _assistance(b: Builder, windup: ca.SX) -> ca.SX:
    """Assist force over the column's own force."""
    share = (windup / b.constant(b.parameter("power_assist.reference"))) ** 2
    return b.constant(b.parameter("power_assist.gain")) * share / (1 + share)


def _mount(b: Builder, travel: ca.SX) -> ca.SX:
    """Force of the rack housing's mount."""
    far = (travel / b.constant(b.parameter("rack_mount.reference"))) ** 2
    stiffening = b.constant(b.parameter("rack_mount.stiffening"))
    return b.constant(b.parameter("rack_mount.rate")) * travel * (1 + stiffening * far / (1 + far))


def _slider(b: Builder, name: str, carrier: Body) -> tuple[Body, ca.SX]:
    """Body that slides along the carrier's Y axis, and its travel in mm."""
    axis = carrier.axes[:, 1]
    travel, slides = slide(name, axis)
    moved = Body(name, carrier.design, carrier.origin + axis * travel, carrier.gibbs, carrier.axes)
    return b.join(name, moved, carrier, slides), travel
