"""A campaign: designs in, outcomes out; what the store has is not run again."""

from __future__ import annotations

import contextlib
import platform
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path

from doe_kc import __version__
from doe_kc.campaign.executors import executor_for, in_process
from doe_kc.campaign.interrupts import Interrupts
from doe_kc.campaign.pending import PendingRuns
from doe_kc.campaign.processes import available_cores
from doe_kc.campaign.record import Packed, StoredCurves, StoredEvaluation, design_key, task_for
from doe_kc.campaign.store import Store, open_store
from doe_kc.ground.errors import DoeKcError, RunError
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.protocol import TrueSolver, Values

Progress = Callable[[int], None]
IN_PROCESS_DESIGNS = 2
"""Designs of a quick solver that are run in this process."""
BATCH = 64
"""Designs of a quick solver that a worker runs at most before they are stored: a tenth of a second."""
BATCHES_A_WORKER = 4
"""At least, so that workers end together."""


class Campaign:
    """Evaluates designs by a true solver, each once, and keeps every result. A context manager.

    store: a store that stays the caller's, the path of one to open, or None for one in memory.
    executor: stays the caller's; by default worker processes, as many as `workers` (one per core), or the
    Dask cluster at the address `scheduler`. retry_failed: run stored failures again, once a campaign.
    stored_curves: what is kept of the curves of new evaluations beside their characteristics.
    """

    def __init__(
        self,
        solver: TrueSolver,
        store: Store | Path | None = None,
        *,
        executor: Executor | None = None,
        workers: int | None = None,
        scheduler: str | None = None,
        retry_failed: bool = False,
        stored_curves: StoredCurves = "all",
    ) -> None:
        self.solver = solver
        self.retry_failed = retry_failed
        self.stored_curves = stored_curves
        self.runs = 0
        """True-solver runs made so far."""
        self.asked = 0
        """Designs asked for so far, those that the store had among them."""
        self._ran: set[str] = set()
        self._here = in_process()
        with ExitStack() as made:
            self.store = store if isinstance(store, Store) else made.enter_context(open_store(store, solver))
            self.executor = executor or made.enter_context(executor_for(workers, scheduler))
            self._made = made.pop_all()

    def evaluate(
        self,
        designs: Sequence[Values],
        origin: str,
        progress: Progress = lambda _: None,
        *,
        curves: bool = True,
    ) -> list[Outcome]:
        """Outcomes in the order of the designs (path -> absolute value); failures are values.

        origin: who asks, such as "sample:lhs", kept beside the result. progress: told how many more of the
        designs are done. curves: False leaves curves in the store, for more designs than memory holds; True
        runs designs again that were stored without theirs.
        InputError for an unknown path. RunError when interrupted; what has finished is stored.
        """
        keys = [design_key(values) for values in designs]
        self.asked += len(keys)
        missing = self._missing(keys, designs, curves=curves and self.stored_curves != "none")
        times = Counter(keys)
        progress(sum(n for key, n in times.items() if key not in missing))
        if missing:
            self.solver = self.solver.prepare(designs)
            self._run(missing, origin, lambda key: progress(times[key]))
        windows = self.solver.windows
        return [self.store.outcome(key, windows, curves=curves) for key in keys]

    def _missing(self, keys: Sequence[str], designs: Sequence[Values], *, curves: bool) -> dict[str, Values]:
        out: dict[str, Values] = {}
        for key, values in zip(keys, designs, strict=True):
            if key in out:
                continue
            status = self.store.status(key)
            again = status == "failed" and self.retry_failed and key not in self._ran
            if status is None or again or self.store.lacks_curves(key, self.solver.windows, curves=curves):
                out[key] = values
        return out

    def _run(self, missing: Mapping[str, Values], origin: str, done: Callable[[str], None]) -> None:
        few = self.solver.quick and len(missing) <= IN_PROCESS_DESIGNS
        executor = self._here if few else self.executor
        interrupts = Interrupts()
        task = task_for(self.solver, kept=self.stored_curves)
        flight = PendingRuns(executor, task, missing, interrupts, self._batch_size(len(missing)))
        try:
            with interrupts:
                for landed in flight.results():
                    self._keep(landed, missing, origin)
                    for key, _ in landed:
                        done(key)
        except BaseException as error:
            with contextlib.suppress(DoeKcError):
                for landed in flight.finished():
                    self._keep(landed, missing, origin)
            flight.abandon()
            if isinstance(error, KeyboardInterrupt):
                raise RunError(self._interrupted()) from None
            raise

    def _batch_size(self, designs: int) -> int:
        """How many a task runs: one of a solver that takes its time, whose every result is worth keeping."""
        if not self.solver.quick:
            return 1
        workers = getattr(self.executor, "workers", None) or available_cores()
        return max(1, min(BATCH, designs // (BATCHES_A_WORKER * workers)))

    def _keep(self, landed: Sequence[tuple[str, Packed]], designs: Mapping[str, Values], origin: str) -> None:
        """In one transaction."""
        windows = dict(self.solver.windows)
        created = datetime.now(UTC).isoformat(timespec="milliseconds")
        versions = {
            "doe_kc": __version__,
            "python": platform.python_version(),
            "solver": self.solver.name,
        }
        self.store.put_all(
            [
                StoredEvaluation(
                    key=key,
                    parameters=dict(designs[key]),
                    packed=packed,
                    windows=windows,
                    origin=origin,
                    created=created,
                    versions=versions,
                )
                for key, packed in landed
            ]
        )
        self._ran.update(key for key, _ in landed)
        self.runs += len(landed)

    def _interrupted(self) -> str:
        if self.store.path is None:
            return "interrupted; results written so far are kept, the same command starts again."
        return (
            f"interrupted; {len(self.store)} evaluations are kept in {self.store.path}, the same command "
            "resumes."
        )

    def close(self) -> None:
        """End the workers and close the store that this campaign made for itself."""
        self._made.close()

    def __enter__(self) -> Campaign:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()
