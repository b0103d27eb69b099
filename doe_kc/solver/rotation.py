"""Finite rotations as Gibbs vectors p = e tan(phi / 2), symbolic.

Rational, without singularity below 180 deg, and smooth at zero, so that exact derivatives cost little.
Reference: M. D. Shuster, A survey of attitude representations, J. Astronaut. Sci. 41(4), 1993.
"""

from __future__ import annotations

import casadi as ca

SERIES_LIMIT = 0.02
"""|p|^2 (16 deg) below which atan(|p|)/|p| is its Taylor series."""
SERIES_TERMS = 9
"""Remainder 0.02^9 / 19 = 3e-17: exact in double precision."""


def matrix(p: ca.SX) -> ca.SX:
    """R = ((1 - p.p) I + 2 p p^T + 2 [p]x) / (1 + p.p)."""
    scaled = 2 / (1 + ca.dot(p, p)) * p
    off = ca.skew(scaled)
    return ca.SX.eye(3) + off + off @ ca.skew(p)


def compose(a: ca.SX, b: ca.SX) -> ca.SX:
    """Gibbs vector of R(a) R(b)."""
    return (a + b + ca.cross(a, b)) / (1 - ca.dot(a, b))


def relative(a: ca.SX, b: ca.SX) -> ca.SX:
    """Gibbs vector of R(a)^T R(b), in the axes of a."""
    return compose(-a, b)


def angle_ratio(s: ca.SX) -> tuple[ca.SX, ca.SX]:
    """kappa = 2 atan(sqrt(s)) / sqrt(s) and d kappa / d s, with s = p.p; phi = kappa p."""
    series, slope = ca.SX(0), ca.SX(0)
    for n in reversed(range(SERIES_TERMS)):
        series = series * s + 2 * (-1) ** n / (2 * n + 1)
    for n in reversed(range(1, SERIES_TERMS)):
        slope = slope * s + 2 * n * (-1) ** n / (2 * n + 1)
    large = ca.fmax(s, 0.5 * SERIES_LIMIT)
    root = ca.sqrt(large)
    exact = 2 * ca.atan(root) / root
    exact_slope = (2 / (1 + large) - exact) / (2 * large)
    small = s < SERIES_LIMIT
    return ca.if_else(small, series, exact), ca.if_else(small, slope, exact_slope)


def spring_moment(p: ca.SX, torque: ca.SX, kappa: ca.SX, slope: ca.SX) -> ca.SX:
    """Moment that turns p further, from torques t(phi) conjugate to the rotation vector phi = kappa p.

    m . dtheta = t . dphi; with g = kappa t + 2 kappa' (p.t) p, m = (g + p x g + p (p.g)) / 2.
    """
    g = kappa * torque + 2 * slope * ca.dot(p, torque) * p
    return (g + ca.cross(p, g) + ca.dot(p, g) * p) / 2


def minimal_rotation_from_z(direction: ca.SX) -> ca.SX:
    """Matrix of the shortest turn that takes the z axis to the unit vector `direction`, not -z."""
    return matrix(ca.vertcat(-direction[1], direction[0], 0) / (1 + direction[2]))
