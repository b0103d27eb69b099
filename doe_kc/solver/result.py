"""What solving an axle gives: static state, branches of equilibria, or the reason of a failure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import Datum, LoadCase
from doe_kc.solver.equilibria import March


@dataclass(frozen=True)
class Failure:
    """Why an axle has no solution: where on the path, how it stood last, and the likely cause.

    input: that has no equilibrium; last_input: the last that has one, both in `input_unit`. deflection: the
    joint that stands farthest from design there, in words. cause: a clause.
    """

    load_case: str
    branch: str
    step: int
    input: float
    input_unit: str
    last_input: float
    deflection: str
    cause: str

    def __str__(self) -> str:
        where = self.load_case
        if self.branch:
            where = (
                f"load case {where}, branch {self.branch}, step {self.step} "
                f"(input {self.input:g} {self.input_unit}); "
                f"last equilibrium at {self.last_input:g} {self.input_unit}"
            )
        return f"no equilibrium: {where}, {self.deflection}; {self.cause}"


class NotConverged(RunError):
    """`solve(..., throw=True)` on an axle without a solution; `.failure` says where."""

    def __init__(self, failure: Failure) -> None:
        super().__init__(str(failure))
        self.failure = failure


@dataclass(frozen=True)
class StaticState:
    """The axle at rest at ride height: datum of every load case.

    x0: state before the ride-height offset is applied; x: with it. y: (ny,) outputs.
    """

    x0: FloatArray
    u0: FloatArray
    x: FloatArray
    u: FloatArray
    z: FloatArray
    y: FloatArray
    datum: Datum


@dataclass(frozen=True)
class BranchSolution:
    """Equilibria of one monotone part of a load case; row 0 is where it starts.

    input: (n,) in the case's unit; path: states and outputs of rows 1..n-1; y: (n, ny) of all rows.
    """

    name: str
    input: FloatArray
    y: FloatArray
    x: FloatArray
    z: FloatArray
    u: FloatArray
    path: March


@dataclass(frozen=True)
class CaseSolution:
    """All branches of one load case."""

    load_case: LoadCase
    branches: tuple[BranchSolution, ...]


@dataclass(frozen=True)
class Solution:
    """The whole suite of one axle. output_names: columns of every y.

    failure: None when all cases converged; cases solved before it are kept.
    """

    axle_name: str
    output_names: tuple[str, ...]
    static: StaticState | None
    cases: Mapping[str, CaseSolution]
    failure: Failure | None
    half_track: float

    def column(self, name: str) -> int:
        """Index of an output in y."""
        return self.output_names.index(name)

    @property
    def has_kingpin(self) -> bool:
        """False for an axle whose design vertical stands in for it."""
        return "scrub_radius@L" in self.output_names

    @property
    def equilibria(self) -> int:
        """Number of equilibria solved."""
        return sum(len(b.path.x) for c in self.cases.values() for b in c.branches)

    @property
    def counts(self) -> np.ndarray:
        """(4,) residuals, Jacobians, factorizations, Newton steps."""
        total = np.zeros(4, dtype=np.int64)
        for case in self.cases.values():
            for branch in case.branches:
                total += branch.path.counts
        return total
