"""Force curves through tabulated points: monotone cubic (PCHIP), linear beyond the end points.

Reference: F. N. Fritsch, J. Butland, A method for constructing local monotone piecewise cubic
interpolants, SIAM J. Sci. Stat. Comput. 5(2), 1984, as in `scipy.interpolate.PchipInterpolator`.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from doe_kc.solver.builder import Builder

SymbolicCurve = Callable[[ca.SX], ca.SX]


def symbolic(b: Builder, prefix: str, points: int, *, side: str | None = None) -> SymbolicCurve:
    """The curve whose points are axle values `prefix.x0`, `prefix.y0`, `prefix.m0`, ..."""
    suffix = f"@{side}" if side else ""

    def value(kind: str, i: int) -> ca.SX:
        return b.parameter(f"{prefix}.{kind}{i}{suffix}")

    # cubic a + t (m0 + t (c2 + t c3)), t = x - x_i; coefficients once per design
    pieces = []
    for i in range(points - 1):
        h = value("x", i + 1) - value("x", i)
        slope = (value("y", i + 1) - value("y", i)) / h
        m0, m1 = value("m", i), value("m", i + 1)
        c2 = (3 * slope - 2 * m0 - m1) / h
        c3 = (m0 + m1 - 2 * slope) / h**2
        pieces.append(b.constant(ca.vertcat(value("x", i), value("y", i), m0, c2, c3)))
    last = points - 1
    end = b.constant(ca.vertcat(value("x", last), value("y", last), value("m", last)))

    def at(x: ca.SX) -> ca.SX:
        first = pieces[0]
        result = first[1] + first[2] * (x - first[0])
        for piece in pieces:
            t = x - piece[0]
            cubic = piece[1] + t * (piece[2] + t * (piece[3] + t * piece[4]))
            result = ca.if_else(x >= piece[0], cubic, result)
        return ca.if_else(x >= end[0], end[1] + end[2] * (x - end[0]), result)

    return at
