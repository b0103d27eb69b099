"""Prandtl-Iwan: elastic-slip elements in parallel, rate-independent, with closed minor loops.

Slider j has the stiffness k_j and the strength k_j y_j; over a step its deflection u_j = x - z_j is mapped
back on [-y_j, y_j], exactly for every monotone step, and z_j = x - u_j is what it remembers. A reversal
inside a large loop is forgotten when it closes, and a branch is the virgin curve scaled by two (Masing).
Reference: A. Visintin, Differential Models of Hysteresis, Springer, 1994, chapter III.
"""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.sliders import normal_quantiles


def slider_deflections(x: ca.SX, before: ca.SX, yields: ca.SX, on: ca.SX) -> ca.SX:
    """(n,) elastic deflections at x after a monotone step. before, yields: (n,); on: 0 lets all go."""
    return on * ca.fmin(ca.fmax(x - before, -yields), yields)


def lognormal_yields(spread: ca.SX, count: int) -> ca.SX:
    """(count,) as `yield_ratios`, of a symbolic spread."""
    quantiles = ca.SX(normal_quantiles(count))
    return ca.exp(spread * quantiles) * ca.sum1(ca.exp(-spread * quantiles)) / count
