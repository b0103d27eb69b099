"""Springs whose stiffness goes to a multiple of itself under load."""

from __future__ import annotations

import casadi as ca

from doe_kc.solver.builder import Builder

NMM_PER_NM = 1000.0


def stiffened(b: Builder, prefix: str, side: str, square: ca.SX) -> ca.SX:
    """Relative change of the stiffness: (f - 1) q / (1 + q), q = square / M0^2.

    square: of the moment by the stiffness at rest, (N mm)^2. f, M0: `prefix.loaded_factor`,
    `prefix.reference`.
    """
    reference = b.constant(b.parameter(f"{prefix}.reference@{side}") * NMM_PER_NM)
    share = square / reference**2
    return b.constant(b.parameter(f"{prefix}.loaded_factor@{side}") - 1) * share / (1 + share)
