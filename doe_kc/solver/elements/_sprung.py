"""A ball on a spring: a massless body that may shift on the one that carries it."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from doe_kc.solver.builder import Body, Builder
from doe_kc.solver.freedoms import translations


def sprung_ball(b: Builder, name: str, carrier: Body, ball: ca.SX, force: Callable[[ca.SX], ca.SX]) -> Body:
    """Body at the point `ball` of its carrier, displaced in the carrier's axes.

    force: of a displacement (3,) in mm, what the spring holds against it, N.
    """
    deflection, shifts = translations(name, carrier.axes)
    end = Body(name, ball, carrier.point(ball + deflection), carrier.gibbs, carrier.axes)
    held = force(deflection)
    for i, freedom in enumerate(shifts):
        b.resist(freedom.name, held[i])
    return b.join(name, end, carrier, shifts)
