"""The finished equations of one topology: residual, outputs and state update as symbolic expressions."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from doe_kc.solver.builder import FORCE_SCALE, MOMENT_SCALE, Builder, Unknown
from doe_kc.solver.probe import Probe


@dataclass(frozen=True)
class Equations:
    """Symbols x, c, u, z and expressions of them.

    x: unknowns (coordinates, multipliers, then the tail: pad heights and spring preload).
    p: axle values by `parameter_names`; c: constants, c = constants(p), once per design.
    u: controls by `control_names`; z: friction states before the step.
    residual: (nx,) force (N), moment (N mm) or length (mm) by row; outputs: by `output_names`;
    next_state: (nz,). tail: number of trailing unknowns. slips: unknowns that friction resists.
    e: probes in their units, all zero in the axle; seen: what they show, both (ne,) by `probes`.
    """

    unknowns: tuple[Unknown, ...]
    tail: int
    parameter_names: tuple[str, ...]
    control_names: tuple[str, ...]
    output_names: tuple[str, ...]
    x: ca.SX
    p: ca.SX
    c: ca.SX
    u: ca.SX
    z: ca.SX
    residual: ca.SX
    outputs: ca.SX
    next_state: ca.SX
    constants: ca.SX
    slips: tuple[str, ...]
    probes: tuple[Probe, ...]
    e: ca.SX
    seen: ca.SX


def _balance(b: Builder) -> tuple[list[Unknown], list[ca.SX], list[ca.SX]]:
    """Unknowns, symbols and rows of all joints; children hand their wrench on before parents are read."""
    rows: dict[str, list[ca.SX]] = {}
    for joint in reversed(b.joints):
        child, parent = joint.child, joint.parent
        force, moment = b.wrenches.get(child.name, (ca.SX.zeros(3), ca.SX.zeros(3)))
        rows[joint.label] = [
            f.compliance * ca.dot(f.axis, moment if f.rotates else force)
            - b.resistances.get(f.name, ca.SX(0))
            for f in joint.freedoms
        ]
        if parent is not None:
            b.push(parent, force, child.origin)
            if joint.carries_moment:
                b.turn(parent, moment)
    unknowns = [
        Unknown(f.name, j.label, MOMENT_SCALE if f.rotates else FORCE_SCALE)
        for j in b.joints
        for f in j.freedoms
    ]
    symbols = [f.symbol for j in b.joints for f in j.freedoms]
    return unknowns, symbols, [row for j in b.joints for row in rows[j.label]]


def _resolved_constants(b: Builder) -> ca.SX:
    """Constants as functions of the parameters alone: later ones may be written with earlier ones."""
    symbols, expressions = zip(*b.constants, strict=True)
    resolved, _ = ca.substitute_inplace(list(symbols), list(expressions), [ca.SX(0)])
    return ca.vertcat(*resolved)


def finish(b: Builder) -> Equations:
    """Close the collection: balance of every joint, constraints, equations of the tail."""
    unknowns, symbols, rows = _balance(b)
    return Equations(
        unknowns=(*unknowns, *(u for u, _, _ in b.multipliers), *(u for u, _ in b.tail)),
        tail=len(b.tail),
        parameter_names=tuple(b.parameters),
        control_names=tuple(b.controls),
        output_names=tuple(b.outputs),
        x=ca.vertcat(*symbols, *[m for _, m, _ in b.multipliers], *[s for _, s in b.tail]),
        p=ca.vertcat(*b.parameters.values()),
        c=ca.vertcat(*[s for s, _ in b.constants]),
        u=ca.vertcat(*b.controls.values()),
        z=ca.vertcat(ca.SX(0, 1), *[s for s, _ in b.states]),
        residual=ca.vertcat(
            *rows,
            *[v for _, _, v in b.multipliers],
            *[b.tail_equations[u.name] for u, _ in b.tail],
        ),
        outputs=ca.vertcat(*b.outputs.values()),
        next_state=ca.vertcat(ca.SX(0, 1), *[f for _, f in b.states]),
        constants=_resolved_constants(b),
        slips=tuple(b.slips),
        probes=tuple(p for p, _, _ in b.probes),
        e=ca.vertcat(ca.SX(0, 1), *[s for _, s, _ in b.probes]),
        seen=ca.vertcat(ca.SX(0, 1), *[response() for _, _, response in b.probes]),
    )
