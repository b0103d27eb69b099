"""Solves the load cases of an axle."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.topology import Topology
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import CASE_ORDER, LoadCase
from doe_kc.solver.builder import HOLD_WHEEL, LOAD_CASE
from doe_kc.solver.compiled import MarchLibrary, adaptive_kernel, compiled_kernel
from doe_kc.solver.diagnosis import sweep_failure
from doe_kc.solver.equilibria import March, MarchProblem, Start
from doe_kc.solver.kernel import Kernel, kernel
from doe_kc.solver.lane_march import LaneMarch, lane_march
from doe_kc.solver.library import COMPILE_VARIABLE, CompileError
from doe_kc.solver.march import march_of
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
    lanes: bool = False,
    pool: Executor | None = None,
) -> Solution:
    """All equilibria of the axle's load cases (all, or those named in `cases`).

    compiled: None takes compiled code when a C compiler is there, False Python. throw=False returns a failure
    as `Solution.failure`; throw=True raises NotConverged. lanes: whether compiled code solves load cases side
    by side, the same to rounding; default one after the other. pool: threads for those lanes.
    """
    chosen = _chosen(axle, cases)
    k = kernel(axle.topology)
    library = library_for(axle.topology, compiled)
    options = settings or NewtonSettings()
    c = k.constant_values(dict(axle.values))
    static = static_state(k, library, c, axle, options)
    if isinstance(static, Failure):
        return _ended(axle, k, None, {}, static, throw)
    procedures = {i: _branch_by_branch(k, c, static, case, options) for i, case in chosen.items()}
    ends = _side_by_side(procedures, _marches(k, library, static, lanes=lanes, pool=pool))
    solved: dict[str, CaseSolution] = {}
    for ident in chosen:
        end = ends[ident]
        if isinstance(end, _UnfinishedBranch):
            return _ended(axle, k, static, solved, end.failure(k), throw)
        solved[ident] = end
    return _ended(axle, k, static, solved, None, throw)


def _marches(
    k: Kernel, library: MarchLibrary | None, static: StaticState, *, lanes: bool, pool: Executor | None
) -> _Marches:
    """lanes: side by side where that can be done, what has no march that way alone."""
    beside: LaneMarch | None = None
    if lanes and library is not None:
        with suppress(CompileError):
            beside = lane_march(k.topology, static, pool)

    def marches(problems: Sequence[MarchProblem]) -> Iterator[March]:
        paths = beside.marches(problems) if beside is not None else [None] * len(problems)
        for problem, path in zip(problems, paths, strict=True):
            yield path or march_of(k, library, problem)

    return marches


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
    """A march that ended before its end; its failure is looked for when it is asked for."""

    case: LoadCase
    name: str
    problem: MarchProblem
    path: March

    def failure(self, k: Kernel) -> Failure:
        """See `sweep_failure`."""
        names, own = (self.case.id, self.name, self.case.unit), self.problem
        full = own.active == k.nx
        return sweep_failure(k, own.c, own.start, self.path, own.s, own.u, names, full=full)


_End = CaseSolution | _UnfinishedBranch
_Procedure = Generator[MarchProblem, March, _End]
_Marches = Callable[[Sequence[MarchProblem]], Iterable[March]]


def _branch_by_branch(
    k: Kernel, c: FloatArray, static: StaticState, case: LoadCase, settings: NewtonSettings
) -> _Procedure:
    """Asks for the march of every branch of a load case, one after the other, and is sent each."""
    loop = k.topology.frictional
    done: list[BranchSolution] = []
    for name, inputs in branch_inputs(case, loop=loop).items():
        values = {"preload": static.datum.preload, LOAD_CASE: 1.0, **case.driven(inputs, static.datum)}
        u = control_matrix(k, values, len(inputs))
        start, (x0, y0, z0) = _start(static, done, u, inputs, loop=loop)
        active = k.nx if HOLD_WHEEL in values else k.nx - k.layout.tail
        problem = MarchProblem(c, start, inputs[1:], u[1:], active, settings)
        path = yield problem
        if path.failed is not None:
            return _UnfinishedBranch(case, name, problem, path)
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


def _side_by_side(procedures: Mapping[str, _Procedure], marches: _Marches) -> dict[str, _End]:
    """How each load case ends, of those up to the first that has no solution: the first branch of all, then
    the second, and so on."""
    ends: dict[str, _End] = {}
    asked = {ident: next(procedure) for ident, procedure in procedures.items()}
    while asked:
        following: dict[str, MarchProblem] = {}
        for ident, path in zip(asked, marches(list(asked.values())), strict=False):
            try:
                following[ident] = procedures[ident].send(path)
            except StopIteration as stop:
                ends[ident] = stop.value
                if isinstance(stop.value, _UnfinishedBranch):
                    break  # those behind it are not asked for
        asked = following
    return ends


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
