"""Solved load cases that are kept for a while, so that no axle is solved twice in a row.

An effect of the rig leaves the axle as it is or changes the input of one load case; derivatives are taken
where the residual has just been.
"""

from __future__ import annotations

from collections import OrderedDict
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property

from doe_kc.axle.model import Axle
from doe_kc.load_cases import LoadCase
from doe_kc.solver.result import CaseSolution, Solution, StaticState
from doe_kc.solver.suite import solve

AXLE_CACHE = 2
"""Axles whose solutions are kept, those used last: the one that is varied, and its variation."""
SUITE_CACHE = 3
"""Solved load cases of one axle that are kept, in all its load cases."""


@dataclass(frozen=True)
class _Solved:
    """cases: by load case with its amplitude and gain, those used last behind."""

    output_names: tuple[str, ...]
    static: StaticState | None
    half_track: float
    cases: OrderedDict[LoadCase, CaseSolution]


class Solutions:
    """Solutions of an axle by its values, topology and load cases; each process has its own.

    threads: that solve load cases side by side, and that take their derivatives.
    """

    def __init__(self, threads: int = 1) -> None:
        self._threads = threads
        self._axles: OrderedDict[tuple[object, ...], _Solved] = OrderedDict()

    @cached_property
    def pool(self) -> Executor | None:
        """See `suite.solve`; None for one thread."""
        return ThreadPoolExecutor(self._threads, "load case") if self._threads > 1 else None

    def __call__(self, axle: Axle) -> Solution:
        """As `solve`: NotConverged when a load case has no equilibrium."""
        key = (axle.topology, tuple(axle.values.items()))
        known = self._axles.get(key)
        wanted = axle.load_cases
        missing = [i for i, case in wanted.items() if known is None or case not in known.cases]
        if known is None or missing:
            solved = solve(axle, missing, lanes=True, pool=self.pool)
            if known is None:
                known = _Solved(solved.output_names, solved.static, solved.half_track, OrderedDict())
            known.cases.update({wanted[i]: solved.cases[i] for i in missing})
        self._axles[key] = known
        self._axles.move_to_end(key)
        for case in wanted.values():
            known.cases.move_to_end(case)
        cases = {i: known.cases[case] for i, case in wanted.items()}
        while len(known.cases) > SUITE_CACHE * max(1, len(wanted)):
            known.cases.popitem(last=False)
        while len(self._axles) > AXLE_CACHE:
            self._axles.popitem(last=False)
        return Solution(axle.name, known.output_names, known.static, cases, None, known.half_track)

    def __reduce__(self) -> tuple[type[Solutions], tuple[int]]:
        return Solutions, (self._threads,)
