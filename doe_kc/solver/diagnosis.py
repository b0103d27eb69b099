"""Why a march ended: where the last equilibrium stands, what gives way there, and the likely cause."""

from __future__ import annotations

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.solver.builder import FORCE_SCALE, MOMENT_SCALE
from doe_kc.solver.equilibria import Halt, March, Start
from doe_kc.solver.kernel import Buffered, Kernel
from doe_kc.solver.newton import Newton, NewtonSettings
from doe_kc.solver.result import Failure

SINGULAR = 1e-9
"""Smallest over largest stiffness below which nothing resists; the softest sound axle has 1e-6."""
RUNAWAY = 3.0
"""Growth of the travel per input since the branch began that announces a fold, where it is infinite."""
TANGENT_SHARE = 1e-3
"""Part of the way on which a tangent is measured."""
SOFT_STIFFNESS = 20.0
"""mm that a sub-frame gives way on its bushings; sound ones do by less than 3 mm."""
SUBFRAME = "sub-frame"
TWIST = "strut twist"
"""The rod turns in its tube as the wheel steers: it follows, and is no sign of trouble."""
SIDE_SUFFIXES = {" L": " left", " R": " right"}


def sweep_failure(
    k: Kernel,
    c: FloatArray,
    start: Start,
    path: March,
    s: FloatArray,
    u: FloatArray,
    names: tuple[str, str, str],
    *,
    full: bool,
) -> Failure:
    """Why a march from `start` over the inputs s (n,) under the controls u (n, nu) ended before its end.

    names: load case, branch and unit of the input.

    ValueError when it did not.
    """
    if path.failed is None or path.halt is None:
        raise ValueError("a march that reached its end has no failure")
    at, halt = path.failed, path.halt
    why = cause(k, c, start, halt, float(s[at]), u[at], full=full)
    load_case, branch, unit = names
    return Failure(load_case, branch, at + 1, float(s[at]), unit, halt.s, largest_deflection(k, halt.x), why)


def static_failure(k: Kernel, c: FloatArray, x: FloatArray, u: FloatArray, share: float) -> Failure:
    """Why there is no static state. x (nx,): under the share of the load that could be ramped up, from 0."""
    halt = Halt(share, x, u, np.zeros(k.nz), 0.0)
    if weakest := unresisted(k, c, halt, k.nx):
        why = f"no stiffness along {weakest}"
    elif share <= 0.0:
        why = "the unloaded axle has none at its design position"
    else:
        why = f"too soft: it carries {100.0 * share:.3g} % of the static load and gives way under more"
    where = f"{largest_deflection(k, x)} under {100.0 * share:.3g} % of the static load"
    return Failure("static equilibrium", "", 0, 1.0, "", share, where, why)


def in_words(name: str) -> str:
    """A joint's or freedom's name with its side written out: `knuckle L` -> `knuckle left`."""
    for short, long in SIDE_SUFFIXES.items():
        name = name.replace(short, long)
    return name


def largest_deflection(k: Kernel, x: FloatArray) -> str:
    """The joint that stands farthest from design at x (nx,), e.g. `knuckle left turned by 42 deg`.

    Turns count as on a lever of 100 mm.
    """
    sizes = {
        (joint, scale): float(np.linalg.norm(x[_rows(k, joint, scale)]))
        for joint in dict.fromkeys(u.joint for u in k.layout.unknowns)
        for scale in (FORCE_SCALE, MOMENT_SCALE)
        if _rows(k, joint, scale).any()
    }
    joint, scale = max(sizes, key=lambda key: sizes[key] * (2.0 if key[1] == MOMENT_SCALE else 1.0) * key[1])
    size = sizes[joint, scale]
    if scale == MOMENT_SCALE:
        return f"{in_words(joint)} turned by {np.degrees(2.0 * np.arctan(size)):.3g} deg"
    return f"{in_words(joint)} moved by {size:.3g} mm"


def _rows(k: Kernel, joint: str, scale: float) -> np.ndarray:
    """(nx,) which unknowns are a joint's shifts or turns; forces and the tail are neither."""
    last = len(k.layout.unknowns) - k.layout.tail
    return np.array(
        [
            u.joint == joint and u.scale == scale and i < last and not u.name.startswith(TWIST)
            for i, u in enumerate(k.layout.unknowns)
        ]
    )


def cause(k: Kernel, c: FloatArray, start: Start, halt: Halt, s: float, u: FloatArray, *, full: bool) -> str:
    """The likely cause that there is no equilibrium at s under the controls u (nu,), in one clause."""
    active = k.nx if full else k.nx - k.layout.tail
    weakest = unresisted(k, c, halt, active)
    if weakest:
        return f"no stiffness along {weakest}"
    newton = Newton(k, c, active, NewtonSettings())
    begin = Halt(float(start.s[-1]), start.x[-1], start.u, start.z, 0.0)
    first, ahead = (_travel(newton, at, s, u) for at in (begin, halt))
    joint = in_words(k.layout.unknowns[int(np.argmax(ahead))].joint)
    if halt.snap > 0.0 or ahead.max() > RUNAWAY * first.max():
        far = f"; the next equilibrium is a snap of {halt.snap:.3g} mm away" if halt.snap else ""
        return f"over-centre: {joint} moves ever faster and would fold over{far}"
    subframe = float(np.linalg.norm(halt.x[_rows(k, SUBFRAME, FORCE_SCALE)]))
    if subframe > SOFT_STIFFNESS:
        return f"too soft: the sub-frame gives way by {subframe:.3g} mm on its bushings"
    return f"the joints lock: Newton's method finds no equilibrium beyond it, most moves {joint}"


def _travel(newton: Newton, at: Halt, s: float, u: FloatArray) -> FloatArray:
    """(nx,) travel of the coordinates from an equilibrium towards the controls u at s, per unit of s: along
    the tangent, in mm; 100 mm per Gibbs unit."""
    k = newton.kernel
    part = at.u + TANGENT_SHARE * (u - at.u)
    newton.forget()
    moved = newton.step_from(newton.with_tail(at.x.copy(), part), part, at.z) - at.x
    moved[(k.scale < FORCE_SCALE) | (np.arange(k.nx) >= k.nx - k.layout.tail)] = 0.0
    moved[[u.name.startswith(TWIST) for u in k.layout.unknowns]] = 0.0
    return np.asarray(np.abs(moved) * k.scale / (TANGENT_SHARE * abs(s - at.s)))


def unresisted(k: Kernel, c: FloatArray, halt: Halt, active: int) -> str:
    """The freedom that nothing resists at an equilibrium, in words; empty when every one is."""
    matrix = np.zeros((k.nx, k.nx))
    matrix[k.rows, k.cols] = Buffered(k.functions["jacobian"])(halt.x, c, halt.u, halt.z)
    stiffness = (matrix / k.scale[:, None] / k.scale)[:active, :active]  # N/mm
    if not np.isfinite(stiffness).all():
        return ""
    _, values, directions = np.linalg.svd(stiffness)
    if values[-1] > SINGULAR * values[0]:
        return ""
    return in_words(k.layout.unknowns[int(np.argmax(np.abs(directions[-1])))].name)
