"""Marching along a load case: the driver in Python, and the one call of its compiled twin.

Predictor: Lagrange extrapolation of the last equilibria, the tangent where there is only one. Corrector:
Newton. A step is halved when Newton does not converge, and when what it finds is not the continuation of the
path: beyond a fold there may be another equilibrium, far off, to which no rig would follow without a snap.
Reference: E. L. Allgower, K. Georg, Introduction to Numerical Continuation Methods, SIAM, 2003, chapter 6.
"""

from __future__ import annotations

import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.solver.compiled import MarchLibrary
from doe_kc.solver.equilibria import Halt, March, MarchProblem, Start, substeps
from doe_kc.solver.kernel import Buffered, Kernel
from doe_kc.solver.newton import Iterate, Newton, NewtonSettings

HISTORY = 4
"""Equilibria that a prediction passes through: a cubic in the input."""
PREDICTION_SHARE = 0.1
"""Largest distance between prediction and equilibrium, over the length of the predicted step."""
SMOOTH = 0.03
"""The same below which a halved step may grow again."""
GROWTH = 2.0
"""Longest step over the one before, per input. Both hold with room where the axle touches a bump stop."""
CORNER_DISTANCE = 0.5
"""mm, and 1/100 Gibbs unit (1.1 deg): farthest equilibrium from its prediction where the path has a corner
(contact, lift-off, reversal of friction); the way back must then end where the step began."""
NEGLIGIBLE_DISTANCE = 0.02
"""mm, and 1/100 Gibbs unit: a distance that needs no explanation."""
SLIP = 2e-3
"""mm; a motion under friction that is shorter may reverse unseen."""
ONWARD = 1e-3
"""Part of a step, on which the tangent at its end is measured."""
RETURN = 0.01
"""Over the step, or over its distance from the prediction: how near the way back must come."""


def march(
    kernel: Kernel,
    compiled: MarchLibrary | None,
    c: FloatArray,
    start: Start,
    s: FloatArray,
    u: FloatArray,
    *,
    full: bool = False,
    settings: NewtonSettings | None = None,
) -> March:
    """Equilibria at path coordinates s (n,) under controls u (n, nu).

    full: solve for the tail (pads, preload) too; otherwise the controls prescribe it.
    """
    chosen = settings or NewtonSettings()
    active = kernel.nx if full else kernel.nx - kernel.layout.tail
    return march_of(kernel, compiled, MarchProblem(c, start, s, u, active, chosen))


def march_of(kernel: Kernel, compiled: MarchLibrary | None, problem: MarchProblem) -> March:
    """Of a problem: in Python where `compiled` is None."""
    if compiled is not None:
        return compiled.march(kernel, problem)
    return _Marcher(kernel, problem).run(problem.s, problem.u)


class _Marcher:
    """The Python twin of driver.c."""

    def __init__(self, kernel: Kernel, problem: MarchProblem) -> None:
        c, start, settings = problem.c, problem.start, problem.settings
        self._kernel, self._c, self._guess = kernel, c, start.guess
        self._newton = Newton(kernel, c, problem.active, settings)
        self._finest = 0.5**settings.max_halvings * (1.0 + 1e-9)
        self._out, self._state = (Buffered(kernel.functions[n]) for n in ("outputs", "state_update"))
        self._hs, self._hx = list(start.s[-HISTORY:]), [np.array(x) for x in start.x[-HISTORY:]]
        self._u, self._z = np.array(start.u), np.array(start.z)
        self._slips = kernel.slips
        self._rows: list[FloatArray] = []
        self._snap, self._smooth, self._part = 0.0, True, 1.0

    def run(self, s: FloatArray, u: FloatArray) -> March:
        k, n = self._kernel, len(s)
        x, z, y = np.zeros((n, k.nx)), np.zeros((n, k.nz)), np.zeros((n, k.ny))
        failed = halt = None
        for step in range(n):
            if not self._one_step(step, s[step], u[step]):
                failed = step
                halt = Halt(self._hs[-1], self._hx[-1].copy(), self._u, self._z, self._snap)
                break
            x[step], z[step] = self._hx[-1], self._z
            y[step] = self._out(x[step], self._c, u[step], self._z)
        between = substeps(k, np.array(self._rows)) if self._rows else None
        return March(x, z, y, failed, self._newton.counts, between, halt)

    def _one_step(self, step: int, s_to: float, u_to: FloatArray) -> bool:
        """Whether the step to s_to has been reached."""
        s_from, done = self._hs[-1], 0.0
        while done < 1.0:
            part = min(self._part, 1.0 - done)
            to = 1.0 if done + part >= 1.0 - 1e-12 else done + part
            at = s_from + to * (s_to - s_from)
            u = u_to if to == 1.0 else self._u + (to - done) / (1.0 - done) * (u_to - self._u)
            predicted = self._predicted(at, u)
            self._snap, self._smooth = 0.0, True
            reached = self._newton.equilibrium(predicted, u, self._z)
            if not reached.converged:  # the predictor may be at fault: start from the last equilibrium
                self._newton.forget()
                last = self._newton.with_tail(self._hx[-1].copy(), u)
                reached = self._newton.equilibrium(last, u, self._z)
            sound = reached.converged and self._continues(predicted, reached, at)
            if sound and len(self._slips) and part > self._finest:
                sound = not self._slips_back(predicted, reached.x, at, u)
            if not sound:
                self._newton.forget()
                if part <= self._finest:
                    return False
                self._part = 0.5 * part
                continue
            if self._kernel.nz:
                self._rows.append(np.concatenate([[step, to], u, reached.x, self._z]))
            self._accept(at, reached.x, u)
            done = to
            if self._smooth and self._part < 1.0:
                self._part = min(2.0 * self._part, 1.0)
        return True

    def _predicted(self, at: float, u: FloatArray) -> FloatArray:
        if len(self._hs) > 1 or self._guess:
            return self._newton.with_tail(_predict(self._hs, self._hx, at), u)
        last = self._newton.with_tail(self._hx[-1].copy(), u)
        return self._newton.step_from(last, u, self._z)

    def _accept(self, at: float, x: FloatArray, u: FloatArray) -> None:
        if self._kernel.nz:
            self._z = self._state(x, self._c, u, self._z).copy()
        if len(self._hs) == HISTORY:
            del self._hs[0], self._hx[0]
        self._hs.append(at)
        self._hx.append(x)
        self._u = u

    def _continues(self, predicted: FloatArray, reached: Iterate, at: float) -> bool:
        """Whether an equilibrium continues the path."""
        if self._guess:
            return True
        last = self._hx[-1]
        gap, moved = distance(self._kernel, reached.x, predicted), distance(self._kernel, reached.x, last)
        if gap <= NEGLIGIBLE_DISTANCE:
            return True
        stride = distance(self._kernel, predicted, last)
        self._smooth = gap <= SMOOTH * stride
        if gap <= PREDICTION_SHARE * stride and moved <= self._longest(at):
            return True
        if gap <= CORNER_DISTANCE and self._returns(reached.x, max(gap, moved)):
            return True
        self._snap = gap
        return False

    def _slips_back(self, predicted: FloatArray, x: FloatArray, at: float, u: FloatArray) -> bool:
        """Whether a motion under friction reverses inside a step: its laws hold over monotone motion."""
        slid = (x - self._hx[-1])[self._slips]
        steady = np.abs(slid) <= SLIP
        before = np.zeros_like(slid)
        if len(self._hs) > 1:
            ratio = (at - self._hs[-1]) / (self._hs[-1] - self._hs[-2])
            before = (self._hx[-1] - self._hx[-2])[self._slips] * ratio
        if np.any(~steady & (slid * before < 0.0)):
            return True
        slows = np.abs(slid) < 0.5 * np.abs(before)
        corner = np.abs(x - predicted)[self._slips] > SLIP
        if not np.any(~steady & (slows | corner)):
            return False
        on = u + ONWARD * (u - self._u)
        self._newton.forget()
        following = self._newton.step_from(self._newton.with_tail(x.copy(), on), on, self._z)
        ahead = (following - x)[self._slips] / ONWARD
        return bool(np.any(~steady & (slid * ahead < 0.0) & (np.abs(ahead) > SLIP)))

    def _longest(self, at: float) -> float:
        """mm that the path may go on to `at`, from what it went before."""
        if len(self._hs) < 2:
            return float("inf")
        before = distance(self._kernel, self._hx[-1], self._hx[-2])
        return float(GROWTH * before * abs(at - self._hs[-1]) / abs(self._hs[-1] - self._hs[-2]))

    def _returns(self, x: FloatArray, far: float) -> bool:
        """Whether the way back ends where the step began: it does not from beyond a fold."""
        back = self._newton.equilibrium(self._newton.with_tail(x.copy(), self._u), self._u, self._z)
        return back.converged and distance(self._kernel, back.x, self._hx[-1]) <= RETURN * far


def distance(kernel: Kernel, a: FloatArray, b: FloatArray) -> float:
    """Largest difference of two states' coordinates (nx,) in mm; 100 mm per Gibbs unit."""
    n = kernel.coordinates
    return float(np.max(np.abs(a[:n] - b[:n]) * kernel.scale[:n]))


def _predict(hs: list[float], hx: list[FloatArray], at: float) -> FloatArray:
    x = np.zeros_like(hx[0])
    for i, si in enumerate(hs):
        weight = 1.0
        for j, sj in enumerate(hs):
            if j != i:
                weight *= (at - sj) / (si - sj)
        x += weight * hx[i]
    return x
