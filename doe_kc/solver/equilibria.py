"""What a march along a load case starts from and returns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.solver.kernel import Kernel
from doe_kc.solver.newton import NewtonSettings


@dataclass(frozen=True)
class Halt:
    """Where a march ended before its end: the last equilibrium, at path coordinate s under the controls u.

    snap: distance in mm (100 mm per Gibbs unit) from its prediction of an equilibrium that is not the
    continuation of the path; 0 when Newton's method found none.
    """

    s: float
    x: FloatArray
    u: FloatArray
    z: FloatArray
    snap: float


@dataclass(frozen=True)
class Substeps:
    """Every equilibrium that a march of an axle with friction went through, those inside steps included.

    step: (m,) index of the step; share: (m,) of it, 1 at its end; u: (m, nu), x: (m, nx); z: (m, nz) friction
    states before.
    """

    step: np.ndarray
    share: FloatArray
    u: FloatArray
    x: FloatArray
    z: FloatArray


def substeps(kernel: Kernel, rows: FloatArray) -> Substeps:
    """From rows (m, 2 + nu + nx + nz) of step, share, u, x, z."""
    x, z = 2 + kernel.nu, 2 + kernel.nu + kernel.nx
    return Substeps(rows[:, 0].astype(int), rows[:, 1], rows[:, 2:x], rows[:, x:z], rows[:, z:])


@dataclass(frozen=True)
class March:
    """Equilibria along a branch. x: (n, nx); z: (n, nz) states after each step; y: (n, ny) outputs.

    failed: index of the step that did not converge, or None; rows after it are not filled.
    counts: (4,) residuals, Jacobians, factorizations, Newton steps. between: of an axle with friction.
    halt: of a march that failed.
    """

    x: FloatArray
    z: FloatArray
    y: FloatArray
    failed: int | None
    counts: np.ndarray
    between: Substeps | None = None
    halt: Halt | None = None


@dataclass(frozen=True)
class Start:
    """Known equilibria before the branch, newest last: path coordinates s, states x; controls u and
    friction states z of the newest.

    guess: its only row of x is no equilibrium, so that nothing has to continue it.
    """

    s: FloatArray
    x: FloatArray
    u: FloatArray
    z: FloatArray
    guess: bool = False


@dataclass(frozen=True)
class MarchProblem:
    """Equilibria that are asked for: at path coordinates s (n,) under the controls u (n, nu).

    c: constants of the axle. active: how many unknowns are solved for; the controls prescribe the rest.
    """

    c: FloatArray
    start: Start
    s: FloatArray
    u: FloatArray
    active: int
    settings: NewtonSettings
