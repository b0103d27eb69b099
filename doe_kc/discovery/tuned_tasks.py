"""What a verdict takes of the re-tuned axle without effects: known at the start, wanted at the end."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

from doe_kc.discovery.deferred_tasks import DeferredTask
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screening.scan import Place, scanned_places
from doe_kc.discovery.verdict.held_out import HeldOutScore, score_without
from doe_kc.solver.result import NotConverged


@dataclass(frozen=True)
class TunedTasks:
    """What a verdict takes of the re-tuned axle without effects."""

    tuned: Fit
    scan: DeferredTask[list[tuple[Place, float]] | None]
    """See `scanned_places`; None where the axle has no equilibrium with the instruments in."""
    held_out: Mapping[str, DeferredTask[HeldOutScore]]
    """Load case -> its score."""

    @staticmethod
    def of(tuned: Fit, executor: Executor) -> TunedTasks:
        """Nothing of it has begun."""
        held_out = {case: DeferredTask(executor, score_without, tuned, case) for case in tuned.model.cases}
        return TunedTasks(tuned, DeferredTask(executor, _scan, tuned), held_out)

    @property
    def tasks(self) -> list[DeferredTask[Any]]:
        """All of them, the longest last: nothing may have to wait for it."""
        return [*self.held_out.values(), self.scan]


def _scan(tuned: Fit) -> list[tuple[Place, float]] | None:
    try:
        return scanned_places(tuned)
    except NotConverged:
        return None
