"""Solved load cases that are kept for a while, so that no axle is solved twice in a row.

An effect of the rig leaves the axle as it is or changes the input of one load case; derivatives are taken
where the residual has just been.
"""

from __future__ import annotations

from collections import OrderedDict
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass

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

    threads: that solve load cases side by side, and that take their derivatives. In another process it is
    one, for that does one task of several, until it is told otherwise.
    """

    def __init__(self, threads: int = 1) -> None:
        self.threads = threads
        self._axles: OrderedDict[tuple[object, ...], _Solved] = OrderedDict()
        self._pools: dict[int, Executor] = {}

    @property
    def pool(self) -> Executor | None:
        """See `suite.solve`; None for one thread."""
        if self.threads == 1:
            return None
        if self.threads not in self._pools:
            self._pools[self.threads] = ThreadPoolExecutor(self.threads, "load case")
        return self._pools[self.threads]

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

    def __reduce__(self) -> tuple[type[Solutions], tuple[()]]:
        return Solutions, ()
