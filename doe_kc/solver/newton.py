"""Newton's method on one equilibrium, keeping a factorization as long as it contracts the residual well."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib import import_module

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.solver.kernel import Buffered, Kernel

STALL_LEVEL = 1e-4
"""N; rounding of very stiff parts keeps the residual from falling below the tolerance."""
STALL_STEP = 1e-10
"""mm and Gibbs units: a step that no longer moves anything."""


@dataclass(frozen=True)
class NewtonSettings:
    """tol: largest residual in N (moments over 100 mm, lengths times 1000 N/mm); refresh: contraction
    above which the Jacobian is renewed; max_halvings: a step is given up at 1 / 2^max_halvings of it."""

    tol: float = 1e-7
    refresh: float = 0.1
    max_iterations: int = 25
    max_halvings: int = 10


RIGID_SETTINGS = NewtonSettings(tol=1e-3)
"""Of an axle with joints in place of its bushings: at 1e9 N/mm the rounding of a coordinate is 1e-4 N."""


@dataclass(frozen=True)
class Iterate:
    """Where Newton's method ended. x: (nx,)."""

    converged: bool
    x: FloatArray


@dataclass
class Newton:
    """The solver of one march: the first `active` unknowns are solved for, the others prescribed.

    counts: residuals, Jacobians, factorizations, Newton steps. The same as `newton` of driver.c.
    """

    kernel: Kernel
    c: FloatArray
    active: int
    settings: NewtonSettings
    counts: np.ndarray = field(default_factory=lambda: np.zeros(4, dtype=np.int64))

    def __post_init__(self) -> None:
        self._lapack = import_module("scipy.linalg.lapack")  # slow to import, and compiled kernels need none
        self._res, self._jac = (Buffered(self.kernel.functions[n]) for n in ("residual", "jacobian"))
        m = self.active
        self._keep = (self.kernel.rows < m) & (self.kernel.cols < m)
        self._rows, self._cols = self.kernel.rows[self._keep], self.kernel.cols[self._keep]
        self._scale = self.kernel.scale[:m]
        self._tail = self.kernel.tail_controls
        self._lu: tuple[FloatArray, np.ndarray] | None = None

    def forget(self) -> None:
        """Drop the factorization."""
        self._lu = None

    def with_tail(self, x: FloatArray, u: FloatArray) -> FloatArray:
        """x (nx,) with what the controls u prescribe, in place."""
        if self.active < self.kernel.nx:
            x[self.active :] = u[self._tail]
        return x

    def step_from(self, x: FloatArray, u: FloatArray, z: FloatArray) -> FloatArray:
        """(nx,) one Newton step from x: with the equilibrium of other controls, Euler's along the tangent.

        x itself where the Jacobian is singular.
        """
        r = self._residual(x, u, z)
        if self._lu is None and not self._factor(x, u, z):
            return x
        out = x.copy()
        out[: self.active] -= self._solved(r)
        return out

    def equilibrium(self, x: FloatArray, u: FloatArray, z: FloatArray) -> Iterate:
        """From x; a factorization is renewed when it contracts too little."""
        tol, fresh, iterations = self.settings.tol, False, 0
        r = self._residual(x, u, z)
        now = best = self._norm(r)
        while iterations < self.settings.max_iterations:
            if now <= tol or not np.isfinite(now) or now > 1e6 * best + 1e9:
                break
            if self._lu is None:
                if not self._factor(x, u, z):
                    break
                fresh = True
            iterations += 1
            step, trial, trial_r, following = self._trial(x, r, now, u, z, fresh=fresh)
            if fresh and self._stalled(step, now, following):
                return Iterate(True, x)
            if following > self.settings.refresh * now:
                self._lu = None
                if not fresh and not following <= 0.5 * now:
                    continue  # a stale factorization misled: try a new one
            fresh = False
            x, r, now = trial, trial_r, following
            best = min(best, now)
        return Iterate(now <= tol, x)

    def _residual(self, x: FloatArray, u: FloatArray, z: FloatArray) -> FloatArray:
        self.counts[0] += 1
        return self._res(x, self.c, u, z).copy()

    def _norm(self, r: FloatArray) -> float:
        worst = float(np.abs(r[: self.active] / self._scale).max())
        return worst if worst == worst else float("inf")

    def _factor(self, x: FloatArray, u: FloatArray, z: FloatArray) -> bool:
        matrix = np.zeros((self.active, self.active), order="F")
        nonzeros = self._jac(x, self.c, u, z)[self._keep]
        matrix[self._rows, self._cols] = nonzeros / self._scale[self._rows]
        self.counts[1:3] += 1
        if not np.isfinite(matrix).all():
            return False
        lu, pivots, info = self._lapack.dgetrf(matrix, overwrite_a=True)
        self._lu = (lu, pivots) if info == 0 else None
        return bool(info == 0)

    def _solved(self, r: FloatArray) -> FloatArray:
        assert self._lu is not None
        step, _ = self._lapack.dgetrs(*self._lu, r[: self.active] / self._scale)
        self.counts[3] += 1
        return np.asarray(step)

    def _stalled(self, step: FloatArray, now: float, following: float) -> bool:
        """Whether a fresh step neither moves the axle nor improves a residual that is small already."""
        moved = float(np.abs(step[self._scale >= 1.0]).max())
        return following > 0.5 * now and now <= STALL_LEVEL and moved <= STALL_STEP

    def _trial(
        self, x: FloatArray, r: FloatArray, now: float, u: FloatArray, z: FloatArray, *, fresh: bool
    ) -> tuple[FloatArray, FloatArray, FloatArray, float]:
        """(step, x, residual, norm); the step is halved while a fresh Jacobian sends the residual far up."""
        step, damp = self._solved(r), 1.0
        for _ in range(7):
            trial = x.copy()
            trial[: self.active] -= damp * step
            trial_r = self._residual(trial, u, z)
            following = self._norm(trial_r)
            if following <= 10.0 * now or not fresh:
                break
            damp *= 0.5
        return step, trial, trial_r, following
