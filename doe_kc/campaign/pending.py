"""Designs under way on an executor, in whatever order they land; a lost worker is found out and outlived."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait

from doe_kc.campaign.interrupts import Interrupts
from doe_kc.campaign.record import Packed, Task
from doe_kc.ground.errors import RunError
from doe_kc.true_solver.protocol import Values

LOST = "a worker process was ended from outside"
REMEDY = "often for lack of memory; use fewer --workers"
MOST_LOSSES = 3
"""Designs one after the other that end their worker, from which it is not the designs' fault."""
Landed = tuple[str, Packed]


class PendingRuns:
    """key -> design of `designs`, each run once. Twice as many as there are workers are under way."""

    def __init__(
        self, executor: Executor, task: Task, designs: Mapping[str, Values], interrupts: Interrupts
    ) -> None:
        self._executor = executor
        self._task = task
        self._queue = deque(designs.items())
        self._designs = designs
        self._flying: dict[Future[Packed], str] = {}
        self._interrupts = interrupts
        self._suspects: list[str] = []

    def results(self) -> Iterator[Landed]:
        """Key and result of every design as it lands.

        When a pool breaks, it is made anew and the designs under way run again one by one; a design that
        breaks it alone is a failure. RunError when one after the other does, or the pool cannot be renewed.
        """
        while self._queue or self._flying:
            broken = self._send()
            with self._interrupts.allowed():
                wait(self._flying, return_when=FIRST_COMPLETED)
            suspects = []
            for future in [f for f in self._flying if f.done()]:
                packed = self._packed(future)
                key = self._flying.pop(future)
                if packed is None:
                    suspects.append(key)
                else:
                    yield from self._sentences()
                    yield key, packed
            if suspects or broken:
                yield from self._after_a_break(suspects)
        yield from self._sentences()

    def finished(self) -> Iterator[Landed]:
        """Those that have landed but were not asked for yet; does not wait."""
        for future, key in list(self._flying.items()):
            if future.done() and not future.cancelled() and future.exception() is None:
                yield key, future.result()

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
            key, values = self._queue[0]
            try:
                with self._interrupts.allowed():
                    self._flying[self._executor.submit(self._task, values)] = key
            except BrokenExecutor:
                return True
            self._queue.popleft()
        return False

    def _packed(self, future: Future[Packed]) -> Packed | None:
        """The result; None when it went down with the pool, a failure when its workers were lost."""
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
            return _lost()

    def _after_a_break(self, suspects: list[str]) -> Iterator[Landed]:
        """Run everything that was under way again, each alone, so that the culprit is known."""
        with self._interrupts.allowed():
            wait(self._flying)
        for future, key in list(self._flying.items()):
            packed = self._packed(future)
            del self._flying[future]
            if packed is None:
                suspects.append(key)
            else:
                yield key, packed
        self._renew()
        for key in suspects:
            packed = self._alone(key)
            if packed is not None:
                yield from self._sentences()
                yield key, packed
            else:
                self._mark_crashed(key)

    def _alone(self, key: str) -> Packed | None:
        with self._interrupts.allowed():
            future = self._executor.submit(self._task, self._designs[key])
            self._flying[future] = key
            wait([future])
        packed = self._packed(future)
        del self._flying[future]
        return packed

    def _mark_crashed(self, key: str) -> None:
        """A design that ended its worker; a failure once another design shows that workers can live."""
        self._suspects.append(key)
        if len(self._suspects) >= MOST_LOSSES:
            raise RunError(f"{LOST} time and again, {REMEDY}.")
        self._renew()

    def _sentences(self) -> Iterator[Landed]:
        for key in self._suspects:
            yield key, _lost()
        self._suspects.clear()

    def _renew(self) -> None:
        renew = getattr(self._executor, "renew", None)
        if renew is None:
            raise RunError(f"{LOST}, {REMEDY}.")
        renew()


def _lost() -> Packed:
    return Packed(f"{LOST} twice while it ran this design, {REMEDY}", {}, None, 0.0)
