"""Motions that joints leave free, with their symbols."""

from __future__ import annotations

import casadi as ca

from doe_kc.solver.builder import Freedom


def translations(name: str, axes: ca.SX | None = None) -> tuple[ca.SX, list[Freedom]]:
    """Three displacements in mm along the columns of `axes` (default: chassis axes)."""
    return _three(name, "", ca.SX.eye(3) if axes is None else axes, rotates=False)


def rotations(name: str, axes: ca.SX | None = None) -> tuple[ca.SX, list[Freedom]]:
    """Gibbs vector of three rotations; moment rows along the columns of `axes` (default: chassis)."""
    return _three(name, "r", ca.SX.eye(3) if axes is None else axes, rotates=True)


def slide(name: str, axis: ca.SX) -> tuple[ca.SX, list[Freedom]]:
    """One displacement in mm along `axis` (chassis frame)."""
    symbol = ca.SX.sym(name)
    return symbol, [Freedom(name, symbol, axis, rotates=False)]


def twist(name: str, axis: ca.SX) -> tuple[ca.SX, list[Freedom]]:
    """One rotation tan(phi / 2) about `axis` (chassis frame) through the body's origin."""
    symbol = ca.SX.sym(name)
    return symbol, [Freedom(name, symbol, axis, rotates=True)]


def _three(name: str, prefix: str, axes: ca.SX, *, rotates: bool) -> tuple[ca.SX, list[Freedom]]:
    symbols = ca.SX.sym(name, 3)
    freedoms = [
        Freedom(f"{name}.{prefix}{letter}", symbols[i], axes[:, i], rotates) for i, letter in enumerate("xyz")
    ]
    return symbols, freedoms
