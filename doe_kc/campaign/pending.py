"""Designs under way on an executor, in whatever order they land; a lost worker is found out and outlived."""

from __future__ import annotations

import logging
import os
from collections import deque
from collections.abc import Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait

from doe_kc.campaign.interrupts import Interrupts
from doe_kc.campaign.record import BatchResult, Packed, Task
from doe_kc.ground.errors import RunError
from doe_kc.true_solver.protocol import Values

log = logging.getLogger("doe_kc")
LOST = "a worker process was ended from outside"
REMEDY = "often for lack of memory; use fewer --workers"
MOST_LOSSES = 3
"""Designs one after the other that end their worker, from which it is not the designs' fault."""
Landed = tuple[str, Packed]
Batch = tuple[str, ...]
"""Keys of designs that one task runs."""


class PendingRuns:
    """key -> design of `designs`, each run once, `size` of them by a task. Twice as many tasks as there are
    workers are under way, one with a single worker."""

    def __init__(
        self,
        executor: Executor,
        task: Task,
        designs: Mapping[str, Values],
        interrupts: Interrupts,
        size: int = 1,
    ) -> None:
        self._executor = executor
        self._task = task
        keys = list(designs)
        self._queue = deque(tuple(keys[i : i + size]) for i in range(0, len(keys), size))
        self._designs = designs
        self._flying: dict[Future[BatchResult], Batch] = {}
        self._interrupts = interrupts
        self._suspects: list[str] = []
        self._faults: set[str] = set()

    def results(self) -> Iterator[list[Landed]]:
        """Keys and results of every batch as it lands.

        When a pool breaks, it is made anew and the designs under way run again one by one; a design that
        breaks it alone is a failure. RunError when one after the other does, or the pool cannot be renewed;
        the error of a design that ends the campaign, after the results of its batch before it.
        """
        while self._queue or self._flying:
            broken = self._send()
            with self._interrupts.allowed():
                wait(self._flying, return_when=FIRST_COMPLETED)
            suspects: list[str] = []
            for future in [f for f in self._flying if f.done()]:
                yield from self._landed(future, suspects)
            if suspects or broken:
                yield from self._after_a_break(suspects)
        yield from self._sentences()

    def _landed(self, future: Future[BatchResult], suspects: list[str]) -> Iterator[list[Landed]]:
        """What a task that is done has given; its keys are suspects when it went down with the pool."""
        result = self._result(future)
        batch = self._flying.pop(future)
        if result is None:
            suspects += batch
            return
        yield from self._sentences()
        self._warn(result.fault)
        yield list(zip(batch, result.packed, strict=False))
        if result.error is not None:
            raise result.error

    def _warn(self, fault: str) -> None:
        """Of a fault of the solver of many designs, once: its results are right, only late."""
        if fault and fault not in self._faults:
            self._faults.add(fault)
            log.warning(
                "designs could not be solved side by side (%s); they are solved one by one, which takes "
                "longer.",
                fault,
            )

    def finished(self) -> Iterator[list[Landed]]:
        """Those that have landed but were not asked for yet; does not wait."""
        for future, batch in list(self._flying.items()):
            if future.done() and not future.cancelled() and future.exception() is None:
                yield list(zip(batch, future.result().packed, strict=False))

    def abandon(self) -> None:
        """Forget the rest, and end what runs where that is possible."""
        for future in self._flying:
            future.cancel()
        end = getattr(self._executor, "abandon", None)
        if end is not None:
            end()

    def _send(self) -> bool:
        """Fill up; True when the pool turned out to be broken."""
        workers = getattr(self._executor, "workers", None) or 2 * (os.cpu_count() or 1)
        room = 2 * workers if workers > 1 else 1
        while self._queue and len(self._flying) < room:
            try:
                self._submit(self._queue[0])
            except BrokenExecutor:
                return True
            self._queue.popleft()
        return False

    def _submit(self, batch: Batch) -> Future[BatchResult]:
        with self._interrupts.allowed():
            future = self._executor.submit(self._task, [self._designs[key] for key in batch])
            self._flying[future] = batch
        return future

    def _result(self, future: Future[BatchResult]) -> BatchResult | None:
        """The result; None when it went down with the pool, failures when its workers were lost."""
        try:
            return future.result()
        except BrokenExecutor:
            return None
        except CancelledError:
            raise RunError(
                "the workers were taken away (cancelled from outside); the evaluations stored before are "
                "kept, the same command resumes."
            ) from None
        except getattr(self._executor, "lost", ()):
            batch = self._flying[future]
            if len(batch) == 1:
                return BatchResult((_lost(),))
            self._queue.extend((key,) for key in batch)
            return BatchResult(())

    def _after_a_break(self, suspects: list[str]) -> Iterator[list[Landed]]:
        """Run everything that was under way again, each alone, so that the culprit is known."""
        with self._interrupts.allowed():
            wait(self._flying)
        for future in list(self._flying):
            yield from self._landed(future, suspects)
        self._renew()
        for key in suspects:
            with self._interrupts.allowed():
                future = self._submit((key,))
                wait([future])
            alone: list[str] = []
            yield from self._landed(future, alone)
            if alone:
                self._mark_crashed(key)

    def _mark_crashed(self, key: str) -> None:
        """A design that ended its worker; a failure once another design shows that workers can live."""
        self._suspects.append(key)
        if len(self._suspects) >= MOST_LOSSES:
            raise RunError(f"{LOST} time and again, {REMEDY}.")
        self._renew()

    def _sentences(self) -> Iterator[list[Landed]]:
        if self._suspects:
            yield [(key, _lost()) for key in self._suspects]
        self._suspects.clear()

    def _renew(self) -> None:
        renew = getattr(self._executor, "renew", None)
        if renew is None:
            raise RunError(f"{LOST}, {REMEDY}.")
        renew()


def _lost() -> Packed:
    return Packed(f"{LOST} twice while it ran this design, {REMEDY}", {}, None, 0.0)
