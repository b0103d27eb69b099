"""What a campaign asks of a solver."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

from doe_kc.true_solver.outcome import Outcome

Values = Mapping[str, float]


class TrueSolver(Protocol):
    """Parameter values in, curves or a reason out. Picklable: it goes to worker processes."""

    @property
    def name(self) -> str:
        """A word or two for messages and records."""
        ...

    @property
    def windows(self) -> Mapping[str, float]:
        """Load case -> half-width of the fit window in its input unit, where not the default."""
        return {}

    @property
    def quick(self) -> bool:
        """Whether a run costs so little that one or two are not worth another process."""
        return False

    @property
    def exact(self) -> bool:
        """Whether exact sensitivities of its answers are to be had from the axle."""
        return False

    def describe(self) -> dict[str, str]:
        """Everything that decides its answers apart from the design and the fit windows, by name."""
        ...

    def fingerprint(self) -> str:
        """Hash of what `describe` says: stored evaluations of another fingerprint are not these."""
        return digest(self.describe())

    def prepare(self, designs: Sequence[Values]) -> TrueSolver:
        """The solver to use for these designs; may do one-off work such as compiling, in this process."""
        return self

    def evaluate(self, values: Values) -> Outcome:
        """One design: path -> absolute value. Failure is a value.

        InputError for a path that there is not; RunError when no design could be run.
        """
        ...


@runtime_checkable
class BatchSolver(TrueSolver, Protocol):
    """A true solver that answers many designs faster at once than one by one."""

    @property
    def curves(self) -> bool:
        """Whether outcomes of `evaluate` hold curves."""
        ...

    def evaluate_all(self, designs: Sequence[Values], *, curves: bool) -> list[Outcome]:
        """What `evaluate` gives for each, up to rounding, every number checked. curves: whether outcomes
        shall hold the curves that the solver has.

        InputError when one of them has a path that there is not, or a value that no axle can have.
        """
        ...


def digest(description: Mapping[str, str]) -> str:
    """SHA-256 of a description, 64 hex digits."""
    text = json.dumps(sorted(description.items()), ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()
