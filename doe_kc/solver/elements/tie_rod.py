"""Rod between points of two bodies, such as a tie rod: of axial compliance c, by default rigid, and
perhaps with free play in its ball joint.

Free play: F = k0 dl + k1 (s(dl - gap/2) - s(-dl - gap/2)), s(x) = (x + sqrt(x^2 + e^2)) / 2, with
k0 = 20 N/mm, k1 = 20000 N/mm and e = 2e-3 mm by default; e k1 = 40 N, so that a stiff contact is a sharp one.
"""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.structure import of_side
from doe_kc.solver.builder import Body, Builder, Response
from doe_kc.solver.elements._base import hardpoint
from doe_kc.solver.elements._cuts import stretch

CENTRING_STIFFNESS = 20.0
SMOOTHING = 40.0
"""N; the law's corners are rounded over this force over the contact stiffness."""


def free_play_force(dl: ca.SX, gap: ca.SX, contact: ca.SX, compliance: ca.SX) -> ca.SX:
    """Tension in N at the lengthening dl in mm; contact: k1 in N/mm; compliance: of the rod, mm/N.

    In series with the rod every straight part of the law stays straight, so only its slopes and the ends of
    the gap change; the smoothing is taken along.
    """
    inside = CENTRING_STIFFNESS / (1 + compliance * CENTRING_STIFFNESS)
    both = CENTRING_STIFFNESS + contact
    outside = both / (1 + compliance * both) - inside
    half = gap / 2 * (1 + compliance * CENTRING_STIFFNESS)
    smoothing = SMOOTHING / contact

    def ramp(x: ca.SX) -> ca.SX:
        return (x + ca.sqrt(x**2 + smoothing**2)) / 2

    return inside * dl + outside * (ramp(dl - half) - ramp(-dl - half))


def add_rod(
    b: Builder, name: str, side: str, inner: tuple[Body, str], outer: tuple[Body, str], *, plays: bool
) -> None:
    """Rod between two bodies with the hardpoints of its ends; points `NAME.SIDE` (tension, N) and
    `NAME pull.SIDE` (force on the inner body), the name with spaces."""
    words = name.replace("_", " ")
    (first, at_first), (second, at_second) = inner, outer
    start, end = hardpoint(b, at_first, side), hardpoint(b, at_second, side)
    design = b.constant(ca.norm_2(end - start))
    along = second.point(end) - first.point(start)
    length = ca.norm_2(along)
    lengthening = length - design - stretch(b, words, "along", side, _tension(b, words, side))
    compliance = b.constant(b.parameter(of_side(f"{name}.flexibility", side)))
    if plays:
        gap, contact = (b.constant(b.parameter(of_side(f"{name}.{k}", side))) for k in ("gap", "contact"))
        tension = free_play_force(lengthening, gap, contact, compliance)
    else:
        label = f"{words} {side}".strip()
        tension = b.rigid(label, f"{label} (length)", lengthening, compliance)
    pull = tension * along / length
    b.push(second, -pull, second.point(end))
    b.push(first, pull, first.point(start))
    b.points[f"{words}.{side}"], b.points[f"{words} pull.{side}"] = tension, pull


def _tension(b: Builder, words: str, side: str) -> Response:
    return lambda: b.points[f"{words}.{side}"]
