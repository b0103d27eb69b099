"""Dry friction with state: steering rack in its housing, damper rod in its tube.

Dahl: dF/dx = (Fc / x_pre)(1 - F/Fc sgn dx), exact over a monotone step,
F -> s Fc - (s Fc - F) exp(-|dx| / x_pre). Duhem's class: the same with (1 - F/Fc sgn dx)^i, which is Dahl's
at i = 1 and loads first as Berg's F = Fc x / (x_pre + x) at 2. Prandtl-Iwan: Jenkins elements in parallel,
F = sum clip(k_j (x - z_j), +-F_j), closed minor loops; the distribution of yield displacements makes its
virgin curve the Dahl one, Fc (1 - exp(-x / x_pre)): density y exp(-y / x_pre) of strength, a gamma law. The
same with yield displacements that are log-normal, x_pre = Fc / initial stiffness. Or a backbone of its own:
seven sliders at fixed yield displacements, whose shares in Fc are numbers of the axle, so that any monotone
backbone of decreasing slope is near one of them.
"""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.sliders import BACKBONE_YIELDS, IWAN_ELEMENTS, iwan_yields
from doe_kc.axle.topology import NEARLY_DAHL, FrictionLaw
from doe_kc.solver.builder import LOAD_CASE, Builder
from doe_kc.solver.elements._sliders import lognormal_yields, slider_deflections

LEAST_REST = 1e-9
"""Distance from the limit, over the limit, that stands for none: its powers stay finite."""


def dahl_force(x: ca.SX, x0: ca.SX, f0: ca.SX, level: ca.SX, presliding: ca.SX) -> ca.SX:
    """Force in N at x after a monotone step from (x0, f0)."""
    sign = ca.if_else(x >= x0, 1, -1)
    return sign * level - (sign * level - f0) * ca.exp(-sign * (x - x0) / presliding)


def duhem_force(x: ca.SX, x0: ca.SX, f0: ca.SX, level: ca.SX, presliding: ca.SX, exponent: ca.SX) -> ca.SX:
    """Force in N at x after a monotone step from (x0, f0). With r = 1 - s F / Fc, r' = -r^i / x_pre."""
    sign = ca.if_else(x >= x0, 1, -1)
    before = ca.fmax(1 - sign * f0 / level, LEAST_REST)
    over = exponent - 1
    # beside 0, by which nothing divides, but with a derivative: fits begin at Dahl's own exponent
    power = ca.if_else(ca.fabs(over) < NEARLY_DAHL, over + 2 * NEARLY_DAHL, over)
    far = power * before**power * sign * (x - x0) / presliding
    # an exponent below 1 meets the limit at a finite distance
    rest = before * ca.exp(-ca.log1p(ca.fmax(far, LEAST_REST - 1)) / power)
    return sign * level * (1 - rest)


def add_friction(b: Builder, freedom: str, law: FrictionLaw, x: ca.SX, prefix: str, side: str) -> ca.SX:
    """Friction against the free motion x (mm), with `prefix.force` and `prefix.presliding`.

    Off (and its state reset) where the control `LOAD_CASE` is 0. Returns the force against +x, N.
    """
    suffix = f"@{side}" if side else ""
    level = b.constant(b.parameter(f"{prefix}.force{suffix}"))
    presliding = b.constant(b.parameter(f"{prefix}.presliding{suffix}"))
    on = b.control(LOAD_CASE)
    if law in ("dahl", "duhem"):
        before = ca.SX.sym(f"{freedom} state", 2)
        path = (x, before[0], before[1], level, presliding)
        if law == "dahl":
            force = on * dahl_force(*path)
        else:
            force = on * duhem_force(*path, b.constant(b.parameter(f"{prefix}.exponent{suffix}")))
        b.state(before, ca.vertcat(x, force), freedom=freedom)
    elif law == "iwan":
        before = ca.SX.sym(f"{freedom} state", IWAN_ELEMENTS)
        strength = level / IWAN_ELEMENTS
        rates = strength / (presliding * ca.SX(iwan_yields()))
        each = on * ca.fmin(ca.fmax(rates * (x - before), -strength), strength)
        force = ca.sum1(each)
        b.state(before, x - each / rates, freedom=freedom)
    else:
        yields, shares = _sliders(b, law, prefix, suffix)
        distances = b.constant(presliding * yields)
        before = ca.SX.sym(f"{freedom} state", shares.numel())
        deflections = slider_deflections(x, before, distances, on)
        force = ca.dot(b.constant(level * shares / distances), deflections)
        b.state(before, x - deflections, freedom=freedom)
    b.resist(freedom, force)
    return force


def _sliders(b: Builder, law: FrictionLaw, prefix: str, suffix: str) -> tuple[ca.SX, ca.SX]:
    """(n,) yield displacements over the presliding distance, and (n,) shares in the limit."""
    if law == "lognormal":
        spread = b.parameter(f"{prefix}.spread{suffix}")
        return lognormal_yields(spread, IWAN_ELEMENTS), ca.SX.ones(IWAN_ELEMENTS) / IWAN_ELEMENTS
    count = len(BACKBONE_YIELDS)
    weights = ca.vertcat(*[b.parameter(f"{prefix}.share{i}{suffix}") for i in range(count)])
    return ca.SX(BACKBONE_YIELDS), weights / ca.sum1(weights)
