"""Marching along a load case: the driver in Python, and the one call of its compiled twin.

Predictor: Lagrange extrapolation of the last equilibria. Corrector: Newton, keeping a factorization as
long as it contracts the residual well; step bisection when it does not converge.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import lapack

from doe_kc.solver.compiled import CompiledKernel
from doe_kc.solver.kernel import Buffered, Kernel
from doe_kc.typing import FloatArray

HISTORY = 4
STALL_LEVEL = 1e-4
"""N; rounding of very stiff parts keeps the residual from falling below the tolerance."""
STALL_STEP = 1e-10
"""mm and Gibbs units: a step that no longer moves anything."""


@dataclass(frozen=True)
class Settings:
    """tol: largest residual in N (moments over 100 mm, lengths times 1000 N/mm); refresh: contraction
    above which the Jacobian is renewed; max_halvings: bisections of one step before it is given up."""

    tol: float = 1e-7
    refresh: float = 0.1
    max_iterations: int = 25
    max_halvings: int = 7


@dataclass(frozen=True)
class Path:
    """Equilibria along a branch. x: (n, nx); z: (n, nz) states after each step; y: (n, ny) outputs.

    failed: index of the step that did not converge, or None; rows after it are not filled.
    residual: (nx,) of the last step tried. counts: residuals, Jacobians, factorizations, Newton steps.
    """

    x: FloatArray
    z: FloatArray
    y: FloatArray
    iterations: np.ndarray
    level: FloatArray
    residual: FloatArray
    failed: int | None
    counts: np.ndarray


@dataclass(frozen=True)
class Start:
    """Known equilibria before the branch, newest last: path coordinates s, states x; controls u and
    friction states z of the newest."""

    s: FloatArray
    x: FloatArray
    u: FloatArray
    z: FloatArray


def march(
    kernel: Kernel,
    compiled: CompiledKernel | None,
    c: FloatArray,
    start: Start,
    s: FloatArray,
    u: FloatArray,
    *,
    full: bool = False,
    settings: Settings | None = None,
) -> Path:
    """Equilibria at path coordinates s (n,) under controls u (n, nu).

    full: solve for the tail (pads, preload) too; otherwise the controls prescribe it.
    """
    chosen = settings or Settings()
    active = kernel.nx if full else kernel.nx - kernel.equations.tail
    if compiled is not None:
        return compiled.march(kernel, c, start, s, u, active, chosen)
    return _Marcher(kernel, c, active, chosen).run(start, s, u)


@dataclass
class _Marcher:
    """The Python twin of driver.c."""

    kernel: Kernel
    c: FloatArray
    active: int
    settings: Settings
    counts: np.ndarray = field(default_factory=lambda: np.zeros(4, dtype=np.int64))

    def __post_init__(self) -> None:
        self._res, self._jac, self._out, self._state = (
            Buffered(self.kernel.functions[n]) for n in ("residual", "jacobian", "outputs", "state_update")
        )
        m = self.active
        keep = (self.kernel.rows < m) & (self.kernel.cols < m)
        self._keep = keep
        self._rows, self._cols = self.kernel.rows[keep], self.kernel.cols[keep]
        self._scale = self.kernel.scale[:m]
        self._tail = self.kernel.tail_controls
        self._lu: tuple[FloatArray, np.ndarray] | None = None

    def run(self, start: Start, s: FloatArray, u: FloatArray) -> Path:
        k = self.kernel
        x_out, z_out = np.zeros((len(s), k.nx)), np.zeros((len(s), k.nz))
        y_out = np.zeros((len(s), k.ny))
        iterations, level = np.zeros(len(s), dtype=np.int32), np.zeros(len(s))
        hs, hx = list(start.s[-HISTORY:]), [np.array(x) for x in start.x[-HISTORY:]]
        z, u_now = np.array(start.z), np.array(start.u)
        self._r = np.zeros(k.nx)
        failed = None
        for step in range(len(s)):
            ok, x, z, used = self._one_step(hs, hx, s[step], u_now, u[step], z)
            iterations[step], level[step] = used, self._norm(self._r)
            x_out[step] = x
            if not ok:
                failed = step
                break
            z_out[step], u_now = z, np.array(u[step])
            y_out[step] = self._out(x, self.c, u[step], z)
        return Path(x_out, z_out, y_out, iterations, level, self._r, failed, self.counts)

    def _one_step(
        self,
        hs: list[float],
        hx: list[FloatArray],
        s_to: float,
        u_from: FloatArray,
        u_to: FloatArray,
        z: FloatArray,
    ) -> tuple[bool, FloatArray, FloatArray, int]:
        s_from, done, part, total, halved = hs[-1], 0.0, 1.0, 0, 0
        x = hx[-1]
        while done < 1.0:
            to = 1.0 if done + part >= 1.0 - 1e-12 else done + part
            at = s_from + to * (s_to - s_from)
            u = u_to if to == 1.0 else u_from + (to - done) / (1.0 - done) * (u_to - u_from)
            ok, x, used = self._newton(self._with_tail(_predict(hs, hx, at), u), u, z)
            total += used
            if not ok:
                self._lu = None
                ok, x, used = self._newton(self._with_tail(hx[-1].copy(), u), u, z)
                total += used
            if not ok:
                self._lu = None
                halved += 1
                if halved > self.settings.max_halvings:
                    return False, x, z, total
                part *= 0.5
                continue
            if self.kernel.nz:
                z = self._state(x, self.c, u, z).copy()
            if len(hs) == HISTORY:
                del hs[0], hx[0]
            hs.append(at)
            hx.append(x)
            u_from, done = u, to
            if done < 1.0 and part < 1.0 - done:
                part = min(part * 2.0, 1.0 - done)
        return True, x, z, total

    def _with_tail(self, x: FloatArray, u: FloatArray) -> FloatArray:
        if self.active < self.kernel.nx:
            x[self.active :] = u[self._tail]
        return x

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
        lu, pivots, info = lapack.dgetrf(matrix, overwrite_a=True)
        self._lu = (lu, pivots) if info == 0 else None
        return bool(info == 0)

    def _newton(self, x: FloatArray, u: FloatArray, z: FloatArray) -> tuple[bool, FloatArray, int]:
        """(converged, x, iterations); a factorization is renewed when it contracts too little."""
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
                self._r = r
                return True, x, iterations
            if following > self.settings.refresh * now:
                self._lu = None
                if not fresh and not following <= 0.5 * now:
                    continue  # a stale factorization misled: try a new one
            fresh = False
            x, r, now = trial, trial_r, following
            best = min(best, now)
        self._r = r
        return now <= tol, x, iterations

    def _stalled(self, step: FloatArray, now: float, following: float) -> bool:
        """Whether a fresh step neither moves the axle nor improves a residual that is small already."""
        moved = float(np.abs(step[self._scale >= 1.0]).max())
        return following > 0.5 * now and now <= STALL_LEVEL and moved <= STALL_STEP

    def _trial(
        self, x: FloatArray, r: FloatArray, now: float, u: FloatArray, z: FloatArray, *, fresh: bool
    ) -> tuple[FloatArray, FloatArray, FloatArray, float]:
        """(step, x, residual, norm); the step is halved while a fresh Jacobian sends the residual far up."""
        assert self._lu is not None
        m, damp = self.active, 1.0
        d, _ = lapack.dgetrs(*self._lu, r[:m] / self._scale)
        self.counts[3] += 1
        for _ in range(7):
            trial = x.copy()
            trial[:m] -= damp * d
            trial_r = self._residual(trial, u, z)
            following = self._norm(trial_r)
            if following <= 10.0 * now or not fresh:
                break
            damp *= 0.5
        return d, trial, trial_r, following


def _predict(hs: list[float], hx: list[FloatArray], at: float) -> FloatArray:
    x = np.zeros_like(hx[0])
    for i, si in enumerate(hs):
        weight = 1.0
        for j, sj in enumerate(hs):
            if j != i:
                weight *= (at - sj) / (si - sj)
        x += weight * hx[i]
    return x
