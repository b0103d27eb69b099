"""The package's own solver behind the protocol."""

from __future__ import annotations

import time
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from doe_kc import __version__
from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import ParameterMap, topology_with
from doe_kc.axle.topology import Topology
from doe_kc.effects import observed
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import library_for, solve
from doe_kc.true_solver.outcome import Outcome, failure, from_curves
from doe_kc.true_solver.own_batch import batch_outcomes, can_batch
from doe_kc.true_solver.protocol import Values, digest

PROGRAMS_FROM = 5
"""Designs of one topology from which making its programs, a third of a second, pays: in Python one takes a
tenth of a second."""
BATCH_FROM = 100
"""Designs of one topology that are asked for at once from which they are solved side by side: a fifth of the
time each. It decides by the designs asked for alone,
so that the last digits do not depend on the number of workers or on what the cache holds."""


@dataclass(frozen=True)
class AxleSolver:
    """windows: as in `reduce_all`. curves: whether outcomes hold them, or characteristics alone.

    compiled: topologies to run in compiled code where that can be done; batched: those of which many designs
    are solved side by side. asked: how many designs of each topology have been announced by `prepare`.
    """

    axle: Axle
    windows: Mapping[str, float] = field(default_factory=dict)
    curves: bool = True
    compiled: frozenset[Topology] = frozenset()
    batched: frozenset[Topology] = frozenset()
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
        """Makes programs of the axle's own topology, and of those that enough designs switch to (a strut made
        flexible): in this process, so that forked workers inherit them.
        """
        now = Counter(topology_with(self.axle, values) for values in designs)
        asked = Counter(self.asked) + now
        compiled = {self.axle.topology} | {t for t, n in asked.items() if n >= PROGRAMS_FROM}
        for topology in compiled - self.compiled:
            library_for(topology, None)
        batched = frozenset(t for t, n in now.items() if n >= BATCH_FROM and can_batch(t))
        return replace(self, compiled=frozenset(compiled), batched=batched, asked=dict(asked))

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

    def evaluate_all(self, designs: Sequence[Values], *, curves: bool) -> list[Outcome]:
        """See `BatchSolver`; designs of `batched` topologies side by side, the others one by one."""
        groups = defaultdict[tuple[Topology, tuple[str, ...]], list[int]](list)
        for i, values in enumerate(designs):
            groups[topology_with(self.axle, values), tuple(values)].append(i)
        out: list[Outcome | None] = [None] * len(designs)
        wanted = curves and self.curves
        for (topology, paths), members in groups.items():
            if topology not in self.batched:
                continue
            rows = np.array([[designs[i][path] for path in paths] for i in members], dtype=float)
            table = rows.reshape(len(members), len(paths))
            outcomes = batch_outcomes(
                self.axle, topology, self._map(paths), table, self.windows, curves=wanted
            )
            for i, outcome in zip(members, outcomes, strict=True):
                out[i] = outcome
        single = replace(self, curves=wanted)
        return [
            outcome if outcome is not None else single.evaluate(values)
            for outcome, values in zip(out, designs, strict=True)
        ]


def describe_axle(axle: Axle) -> dict[str, str]:
    """Every fact of a model: topology, load cases, followers, effects, and each number."""
    facts = {
        "topology": repr(axle.topology),
        "followers": repr(sorted(axle.follow.items())),
        "effects": repr(sorted((name, sorted(o.items())) for name, o in axle.effects.items())),
    }
    facts |= {f"load case {ident}": repr(case) for ident, case in axle.load_cases.items()}
    return facts | {name: repr(float(value)) for name, value in axle.values.items()}
