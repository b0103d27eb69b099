"""The package's own solver behind the protocol."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from doe_kc import __version__
from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import ParameterMap, topology_with
from doe_kc.axle.topology import Topology
from doe_kc.effects import observed
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import library_for, solve
from doe_kc.true_solver.outcome import Outcome, failure, from_curves
from doe_kc.true_solver.protocol import Values, digest

COMPILE_FROM = 50
"""Designs of one topology from which compiling it, some seconds, pays."""


@dataclass(frozen=True)
class AxleSolver:
    """windows: as in `reduce_all`. curves: whether outcomes hold them, or characteristics alone.

    compiled: topologies to run compiled where that is possible. asked: how many designs of each topology
    have been announced by `prepare`.
    """

    axle: Axle
    windows: Mapping[str, float] = field(default_factory=dict)
    curves: bool = True
    compiled: frozenset[Topology] = frozenset()
    asked: Mapping[Topology, int] = field(default_factory=dict)

    @property
    def name(self) -> str:
        return "doe_kc"

    @property
    def quick(self) -> bool:
        return True

    @property
    def exact(self) -> bool:
        return True

    def describe(self) -> dict[str, str]:
        return {"solver": f"{self.name} {__version__}", **describe_axle(self.axle)}

    def fingerprint(self) -> str:
        return digest(self.describe())

    def prepare(self, designs: Sequence[Values]) -> AxleSolver:
        """Compiles the axle's own topology, and those that enough designs switch to (a strut made flexible).

        In this process, so that forked workers inherit the equations and none compiles for itself.
        """
        asked = Counter(self.asked)
        asked.update(topology_with(self.axle, values) for values in designs)
        compiled = {self.axle.topology} | {t for t, n in asked.items() if n >= COMPILE_FROM}
        for topology in compiled - self.compiled:
            library_for(topology, None)
        return replace(self, compiled=frozenset(compiled), asked=dict(asked))

    @cached_property
    def _maps(self) -> dict[tuple[str, ...], ParameterMap]:
        return {}

    def _map(self, paths: tuple[str, ...]) -> ParameterMap:
        """Of the paths, which the designs of a campaign have in common."""
        if paths not in self._maps:
            self._maps[paths] = ParameterMap(self.axle, paths)
        return self._maps[paths]

    def evaluate(self, values: Values) -> Outcome:
        """All load cases of the axle; InputError for an unknown path or a value that no axle can have."""
        started = time.perf_counter()
        changed = self._map(tuple(values)).axle(tuple(values.values()))
        solution = solve(changed, throw=False, compiled=None if changed.topology in self.compiled else False)
        seconds = time.perf_counter() - started
        if solution.failure is not None:
            return failure(str(solution.failure), seconds)
        outcome = from_curves(observed(changed, curve_set(solution)), self.windows, seconds)
        return outcome if self.curves else replace(outcome, curves=None)


def describe_axle(axle: Axle) -> dict[str, str]:
    """Every fact of a model: topology, load cases, followers, effects, and each number."""
    facts = {
        "topology": repr(axle.topology),
        "followers": repr(sorted(axle.follow.items())),
        "effects": repr(sorted((name, sorted(o.items())) for name, o in axle.effects.items())),
    }
    facts |= {f"load case {ident}": repr(case) for ident, case in axle.load_cases.items()}
    return facts | {name: repr(float(value)) for name, value in axle.values.items()}
