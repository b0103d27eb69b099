"""Six-axis bushing between an inner and an outer body.

Force per local axis F = k (d + b d^3) + f0 or F = factor * table(d) + f0, d = outer minus inner point in
the axes of the inner part, and for rubber the force of parallel sliders beside it (see `_sliders`); torque is
the gradient of 1/2 phi^T K phi with phi the rotation vector of inner^T outer. The force pair acts at the
displaced outer point, so the couple d x F loads the inner part.

The right side is the mirror image. Deflections and forces along mirrored axes are mirror images as they are;
rotations and torques about them are so with the opposite sign (they are axial vectors), which a table that is
not odd needs.
"""

from __future__ import annotations

import casadi as ca

from doe_kc.axle.model import FORCE_AXES, NM_PER_DEG
from doe_kc.axle.sliders import RUBBER_SLIDERS
from doe_kc.axle.structure import of_side
from doe_kc.solver import curve, rotation
from doe_kc.solver.builder import LOAD_CASE, Body, Builder, Response
from doe_kc.solver.elements._cuts import ROTATION_AXES, SHIFTS, push_pair, stretch, turn_pair, turn_sign
from doe_kc.solver.elements._sliders import lognormal_yields, slider_deflections

TORQUE_AXES = ("Tx", "Ty", "Tz")
RUBBER = ("share", "yield", "spread")
"""Values of a bushing's friction: see `_friction`."""


def connect(
    b: Builder, name: str, side: str, *, at: ca.SX, axes: ca.SX, inner: Body | None, outer: Body
) -> None:
    """Bushing `name` at the design point `at`; `axes`: (3, 3) local axes as columns, in the inner part.

    inner None is the vehicle body.
    """
    outer_point = outer.point(at)
    apart = outer_point - (inner.point(at) if inner is not None else at)
    gibbs = outer.gibbs
    if inner is not None:
        apart = inner.axes.T @ apart
        gibbs = rotation.relative(inner.gibbs, outer.gibbs)
    d = axes.T @ apart
    friction, local = _friction(b, name, side, d), list[ca.SX]()
    for i, axis in enumerate(FORCE_AXES):
        moved = stretch(b, f"{name}|body", SHIFTS[i], side, _item(local, i)) if inner is None else 0
        pair = push_pair(b, name, SHIFTS[i], side, d[i])
        local.append(_force(b, name, side, axis, d[i] - moved) + friction[i] + pair)
    kappa, slope = rotation.angle_ratio(ca.dot(gibbs, gibbs))
    phi = axes.T @ (kappa * gibbs)
    turned = [
        _torque(b, name, side, a, phi[i]) + turn_pair(b, name, ROTATION_AXES[i], side, phi[i])
        for i, a in enumerate(TORQUE_AXES)
    ]
    force, torque = axes @ ca.vertcat(*local), axes @ ca.vertcat(*turned)
    moment = rotation.spring_moment(gibbs, torque, kappa, slope)
    if inner is not None:
        force, moment = inner.axes @ force, inner.axes @ moment
        b.push(inner, force, outer_point)
        b.turn(inner, moment)
    b.push(outer, -force, outer_point)
    b.turn(outer, -moment)


def _item(values: list[ca.SX], i: int) -> Response:
    return lambda: values[i]


def _force(b: Builder, name: str, side: str, axis: str, d: ca.SX) -> ca.SX:
    factor = b.parameter(of_side(f"{name}.{axis}", side))
    preload = b.constant(b.parameter(of_side(f"{name}.preload.{axis}", side)))
    if table := _table(b, name, side, axis):
        return b.constant(factor) * table(d) + preload
    k = b.constant(factor * b.parameter(of_side(f"{name}.stiffness.{axis}", side)))
    cubic = b.constant(b.parameter(of_side(f"{name}.cubic.{axis}", side)))
    return k * (d + cubic * d**3) + preload


def _friction(b: Builder, name: str, side: str, d: ca.SX) -> list[ca.SX]:
    """Forces of the rubber's sliders along the three axes in N, none for a bushing without.

    The sliders of an axis are of equal strength. Together they are as stiff as a share of the axis itself at
    zero deflection, and hold at most that stiffness times the yield distance.
    """
    if name not in b.topology.rubber:
        return [ca.SX(0)] * len(FORCE_AXES)
    share, distance, spread = (b.parameter(of_side(f"{name}.rubber.{key}", side)) for key in RUBBER)
    yields = b.constant(distance * lognormal_yields(spread, RUBBER_SLIDERS))
    weights = b.constant(share * distance / RUBBER_SLIDERS / yields)
    forces = []
    for i, axis in enumerate(FORCE_AXES):
        before = ca.SX.sym(f"{name} {axis} {side} state", RUBBER_SLIDERS)
        deflections = slider_deflections(d[i], before, yields, b.control(LOAD_CASE))
        b.state(before, d[i] - deflections)
        forces.append(b.constant(_stiffness(b, name, side, axis)) * ca.dot(weights, deflections))
    return forces


def _stiffness(b: Builder, name: str, side: str, axis: str) -> ca.SX:
    """N/mm at zero deflection."""
    factor = b.parameter(of_side(f"{name}.{axis}", side))
    if table := _table(b, name, side, axis):
        at = ca.SX.sym("d")
        return factor * ca.substitute(ca.jacobian(table(at), at), at, 0)
    return factor * b.parameter(of_side(f"{name}.stiffness.{axis}", side))


def _torque(b: Builder, name: str, side: str, axis: str, phi: ca.SX) -> ca.SX:
    factor = b.parameter(of_side(f"{name}.{axis}", side))
    if table := _table(b, name, side, axis):
        return b.constant(factor) * turn_sign(side) * table(turn_sign(side) * phi)
    return b.constant(factor * b.parameter(of_side(f"{name}.stiffness.{axis}", side)) * NM_PER_DEG) * phi


def _table(b: Builder, name: str, side: str, axis: str) -> curve.SymbolicCurve | None:
    for bushing, tabulated, points in b.topology.tables:
        if (bushing, tabulated) == (name, axis):
            return curve.symbolic(b, f"{name}.table.{axis}", points, side=side)
    return None
