"""Anti-roll bar: vertical forces F = k (dz_L - dz_R) at the drop links.

dz is the travel from design: the links are assembled to the length at which the bar is free of force there,
whatever the design heights of the two sides.

The bar follows the fourth power of the outer radius, k_bar = k_nominal (r / r_nominal)^4, the law of a solid
round bar k = G pi r^4 / (2 L a^2) with its lever a fixed by the nominal pair. A drop link of compliance c at
either end is in series with it, 1 / k = 1 / k_bar + 2 c.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import casadi as ca

from doe_kc.curves import SIDES
from doe_kc.solver.builder import Body, Builder, Response
from doe_kc.solver.elements._base import hardpoint
from doe_kc.solver.elements._cuts import stretch


def add_anti_roll_bar(b: Builder, bodies: Sequence[Body], at: str) -> None:
    """Forces of the bar on a left and a right body at the hardpoint `at`."""
    ratio = b.parameter("arb.radius") / b.parameter("arb.nominal_radius")
    bar = b.parameter("arb.rate") * ratio**4
    rate = b.constant(bar / (1 + 2 * bar * b.parameter("arb.link_flexibility")))
    links = [each.point(hardpoint(b, at, s)) for each, s in zip(bodies, SIDES, strict=True)]
    design = b.constant(hardpoint(b, at, "L")[2] - hardpoint(b, at, "R")[2])
    handed: dict[str, ca.SX] = {}
    left, right = (stretch(b, "drop link", "z", s, _of(handed, s)) for s in SIDES)
    up = rate * (links[0][2] - left - (links[1][2] - right) - design)
    handed |= {"L": up, "R": -up}
    force = ca.vertcat(0, 0, up)
    b.push(bodies[0], -force, links[0])
    b.push(bodies[1], force, links[1])


def _of(handed: Mapping[str, ca.SX], side: str) -> Response:
    return lambda: handed[side]
