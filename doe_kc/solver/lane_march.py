"""Marches of one topology side by side, one in each lane of the vector registers: load cases of one axle.

By programs all load cases of an axle with friction cost a tenth to a fifth less in four lanes than by a
compiled kernel one after the other, and nothing has to be compiled; compiled for lanes they cost 0.6 of that.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from concurrent.futures import Executor

import numpy as np

from doe_kc.axle.topology import Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.batch_library import (
    AdaptiveBatch,
    BatchMarch,
    BatchProblem,
    BatchStart,
    adaptive_batch,
)
from doe_kc.solver.builder import HOLD_WHEEL, LOAD_CASE
from doe_kc.solver.elimination import EliminationOrder, paired_order
from doe_kc.solver.equilibria import March, MarchProblem
from doe_kc.solver.instructions import own_instruction_set
from doe_kc.solver.kernel import kernel
from doe_kc.solver.result import StaticState
from doe_kc.solver.static import control_matrix

LANES = 4
"""Eight load cases take 1.4 times as long in eight lanes: those that have ended have no other to go on with,
and registers twice as wide take more time."""


class LaneMarch:
    """No number of a march depends on those beside it.

    marcher: of the axle's topology. static: the axle at rest, whose Jacobian tells the order of elimination.
    pool: threads that each take as many marches as there are lanes. Two end 15 to 30 % sooner than one that
    takes all, and take 15 to 30 % more of the cores' time.
    """

    def __init__(self, marcher: AdaptiveBatch, static: StaticState, pool: Executor | None) -> None:
        self._kernel, self._marcher = kernel(marcher.topology), marcher
        self._static, self._pool = static, pool
        self._orders: dict[int, EliminationOrder | None] = {}

    def marches(self, problems: Sequence[MarchProblem]) -> list[March | None]:
        """Each as `march.march` gives it to rounding, in their order; None for one that has no such march.

        They are of one axle and one tolerance.
        """
        alike: dict[tuple[int, int], list[int]] = defaultdict(list)
        for i, problem in enumerate(problems):
            alike[problem.active, len(problem.start.s)].append(i)
        for problem in problems:
            if problem.active not in self._orders:
                self._orders[problem.active] = self._order(problem.c, problem.active)
        groups = [group for places in alike.values() for group in self._dealt(places, problems)]
        side_by_side = map if self._pool is None else self._pool.map
        every = side_by_side(self._alike, [[problems[i] for i in group] for group in groups])
        out: dict[int, March | None] = {}
        for group, paths in zip(groups, every, strict=True):
            out |= zip(group, paths, strict=True)
        return [out[i] for i in range(len(problems))]

    def _dealt(self, places: Sequence[int], problems: Sequence[MarchProblem]) -> list[list[int]]:
        """All of them, for threads as few groups as the lanes hold, of about as many steps each; the long
        ones first, or one ends alone."""
        count = 1 if self._pool is None else -(-len(places) // self._marcher.lanes)
        by_length = sorted(places, key=lambda i: -len(problems[i].s))
        return [by_length[k::count] for k in range(count)]

    def _alike(self, problems: Sequence[MarchProblem]) -> list[March | None]:
        """Of as many unknowns and as many known points each."""
        first, count = problems[0], len(problems)
        order = self._orders[first.active]
        if order is None:
            return [None] * count
        starts, steps = [p.start for p in problems], np.array([len(p.s) for p in problems])
        s, x, u, z = (np.array([getattr(at, name) for at in starts]) for name in ("s", "x", "u", "z"))
        problem = BatchProblem(
            np.broadcast_to(first.c, (count, len(first.c))),
            BatchStart(s, x, u, z),
            _in_rows([p.s for p in problems]),
            _in_rows([p.u for p in problems]),
            np.arange(self._kernel.ny),
            np.zeros(count, dtype=bool),
            first.settings,
            steps,
            path=True,
        )
        batch = self._marcher.march(self._kernel, order, problem)
        return [None if batch.failed[i] else _one(batch, i, int(n)) for i, n in enumerate(steps)]

    def _order(self, c: FloatArray, active: int) -> EliminationOrder | None:
        """Of so many unknowns; None where the axle at rest is singular."""
        k, at = self._kernel, self._static
        held = {HOLD_WHEEL: 1.0, "bilateral": 1.0} if active == k.nx else {}
        u = at.u + control_matrix(k, {LOAD_CASE: 1.0, **held}, 1)[0]
        try:
            return paired_order(k, self._marcher.jacobian(at.x, c, u, at.z), active)
        except np.linalg.LinAlgError:
            return None


def lane_march(topology: Topology, static: StaticState, pool: Executor | None) -> LaneMarch:
    """Of a topology, on this processor; CompileError when that cannot or shall not be built."""
    return LaneMarch(adaptive_batch(topology, own_instruction_set().of_lanes(LANES)), static, pool)


def _in_rows(arrays: Sequence[FloatArray]) -> FloatArray:
    """(d, n, ...) of (n_i, ...), the shorter ones with zeros behind."""
    out = np.zeros((len(arrays), max(map(len, arrays)), *arrays[0].shape[1:]))
    for row, array in zip(out, arrays, strict=True):
        row[: len(array)] = array
    return out


def _one(batch: BatchMarch, place: int, steps: int) -> March:
    path = batch.path
    assert path is not None
    return March(
        batch.x[place, :steps],
        path.z[place, :steps],
        batch.y[place, :steps],
        None,
        path.counts[place],
        None if path.between is None else path.between[place],
    )
