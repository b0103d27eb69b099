"""Solves the load cases of an axle."""

from __future__ import annotations

import logging
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.topology import Topology
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import CASE_ORDER, LoadCase
from doe_kc.solver.builder import LOAD_CASE
from doe_kc.solver.compiled import MarchLibrary, adaptive_kernel, compiled_kernel
from doe_kc.solver.diagnosis import sweep_failure
from doe_kc.solver.equilibria import March, Start
from doe_kc.solver.kernel import Kernel, kernel
from doe_kc.solver.library import COMPILE_VARIABLE, CompileError
from doe_kc.solver.march import march
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.result import (
    BranchSolution,
    CaseSolution,
    Failure,
    NotConverged,
    Solution,
    StaticState,
)
from doe_kc.solver.static import control_matrix, static_state

log = logging.getLogger("doe_kc")
SEEDS = 3
"""Equilibria of the other branch before the static one, from which the first prediction is cubic."""


def solve(
    axle: Axle,
    cases: Sequence[str] | None = None,
    *,
    compiled: bool | None = None,
    settings: NewtonSettings | None = None,
    throw: bool = True,
    pool: Executor | None = None,
) -> Solution:
    """All equilibria of the axle's load cases (all, or those named in `cases`).

    compiled: None takes compiled code when a C compiler is there, False Python. throw=False returns a failure
    as `Solution.failure`; throw=True raises NotConverged. pool: threads in which compiled code solves load
    cases side by side, to the same digits; default one after the other.
    """
    chosen = _chosen(axle, cases)
    k = kernel(axle.topology)
    library = library_for(axle.topology, compiled)
    options = settings or NewtonSettings()
    c = k.constant_values(dict(axle.values))
    static = static_state(k, library, c, axle, options)
    if isinstance(static, Failure):
        return _ended(axle, k, None, {}, static, throw)

    def solve_case(case: LoadCase) -> CaseSolution | _UnfinishedBranch:
        return _solve_case(k, library, c, static, case, options)

    side_by_side = map if pool is None or library is None else pool.map
    solved: dict[str, CaseSolution] = {}
    for ident, result in zip(chosen, side_by_side(solve_case, chosen.values()), strict=True):
        if isinstance(result, _UnfinishedBranch):
            return _ended(axle, k, static, solved, result.failure(k, c), throw)
        solved[ident] = result
    return _ended(axle, k, static, solved, None, throw)


def _chosen(axle: Axle, cases: Sequence[str] | None) -> dict[str, LoadCase]:
    for name in cases or ():
        if name not in axle.load_cases:
            raise InputError(
                f"{name!r} is not a load case of this axle; known are {', '.join(axle.load_cases)}."
                f"{nearest(name, axle.load_cases)}"
            )
    return {i: axle.load_cases[i] for i in (cases if cases is not None else ordered_cases(axle.load_cases))}


def ordered_cases(cases: Mapping[str, LoadCase]) -> list[str]:
    """Load cases in the order in which they are solved."""
    return [i for i in CASE_ORDER if i in cases] + [i for i in cases if i not in CASE_ORDER]


def _ended(
    axle: Axle,
    k: Kernel,
    static: StaticState | None,
    cases: Mapping[str, CaseSolution],
    failure: Failure | None,
    throw: bool,
) -> Solution:
    if failure is not None and throw:
        raise NotConverged(failure)
    return Solution(axle.name, k.layout.output_names, static, cases, failure, axle.half_track)


def library_for(topology: Topology, compiled: bool | None) -> MarchLibrary | None:
    """What marches in compiled code, or None for Python; one notice when there is no compiler.

    compiled: True compiles the topology's own kernel now, None when that pays.
    """
    if compiled is False or (compiled is None and os.environ.get(COMPILE_VARIABLE) == "0"):
        return None
    try:
        return compiled_kernel(topology) if compiled else adaptive_kernel(topology)
    except CompileError as error:
        if compiled:
            raise
        _notice_once(str(error))
        return None


@lru_cache(maxsize=1)
def _notice_once(reason: str) -> None:
    log.warning("running interpreted, about ten times slower: %s", reason)


def branch_inputs(case: LoadCase, *, loop: bool) -> dict[str, FloatArray]:
    """Inputs of every branch, the first being where it starts: two from zero, or loops with friction.

    What is driven before the loop that counts has half as many: nothing but its end is asked for, and that
    hangs on where motions under friction reverse, not on the equilibria between.
    """
    up = np.linspace(0.0, 1.0, case.steps + 1) * case.amplitude
    if not loop:
        return {"pos": up, "neg": -up}
    around = case.loop_inputs()
    first = np.linspace(0.0, 1.0, (case.steps + 1) // 2 + 1) * case.amplitude
    across = np.linspace(-1.0, 1.0, case.steps + 1) * case.amplitude
    before = {
        f"{name}_{k}": values
        for k in range(1, case.conditioning + 1)
        for name, values in (("unload", across[::-1].copy()), ("load", across))
    }
    return {"init": first, **before, "unload": around[::-1].copy(), "load": around}


@dataclass(frozen=True)
class _UnfinishedBranch:
    """A march that ended before its end; its failure is looked for in one thread."""

    case: LoadCase
    branch: str
    start: Start
    path: March
    input: FloatArray
    u: FloatArray
    full: bool

    def failure(self, k: Kernel, c: FloatArray) -> Failure:
        """See `sweep_failure`."""
        names = (self.case.id, self.branch, self.case.unit)
        return sweep_failure(k, c, self.start, self.path, self.input, self.u, names, full=self.full)


def _solve_case(
    k: Kernel,
    library: MarchLibrary | None,
    c: FloatArray,
    static: StaticState,
    case: LoadCase,
    settings: NewtonSettings,
) -> CaseSolution | _UnfinishedBranch:
    loop = k.topology.frictional
    done: list[BranchSolution] = []
    full = False
    for name, inputs in branch_inputs(case, loop=loop).items():
        values = {"preload": static.datum.preload, LOAD_CASE: 1.0, **case.driven(inputs, static.datum)}
        full = "hold_wheel_centre" in values
        u = control_matrix(k, values, len(inputs))
        start, origin = _start(static, done, u, inputs, loop=loop)
        path = march(k, library, c, start, inputs[1:], u[1:], full=full, settings=settings)
        if path.failed is not None:
            return _UnfinishedBranch(case, name, start, path, inputs[1:], u[1:], full)
        x0, y0, z0 = origin
        done.append(
            BranchSolution(
                name,
                inputs,
                np.concatenate([y0[None], path.y]),
                np.concatenate([x0[None], path.x]),
                np.concatenate([z0[None], path.z]),
                u,
                path,
            )
        )
    return CaseSolution(case, tuple(done))


def _start(
    static: StaticState,
    done: list[BranchSolution],
    u: FloatArray,
    inputs: FloatArray,
    *,
    loop: bool,
) -> tuple[Start, tuple[FloatArray, FloatArray, FloatArray]]:
    """Where a branch starts, and first equilibria of the opposite branch as the predictor's history."""
    if loop and done:
        last = done[-1]
        origin = (last.x[-1], last.y[-1], last.z[-1])
        return Start(inputs[:1], last.x[-1:], u[0], last.z[-1]), origin
    origin = (static.x, static.y, static.z)
    if not done:
        return Start(inputs[:1], static.x[None, :], u[0], static.z), origin
    seeds = np.arange(SEEDS, 0, -1)
    s = np.concatenate([done[0].input[seeds], inputs[:1]])
    x = np.concatenate([done[0].x[seeds], static.x[None]])
    return Start(s, x, u[0], static.z), origin
