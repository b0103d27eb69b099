"""The one thread that solves: the latest request wins, one solve in flight, one waiting.

Everything that touches the solver goes through it: compiled kernels work in buffers of their own and must not
be entered twice.
"""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable

from doe_kc.ground.threads import limit_process
from doe_kc.live.session import Session, SolveRequest

log = logging.getLogger("doe_kc")
QUIET = 0.3
"""Seconds without a request after which the sensitivities of the present answer are computed."""
Job = Callable[[], None]


class LiveWorker:
    """answered: called in the thread after each solve, with its request. quiet: called once when there is
    nothing left to do after a solve."""

    def __init__(self, session: Session, answered: Callable[[SolveRequest], None], quiet: Job) -> None:
        self._session, self._answered, self._quiet = session, answered, quiet
        self._wake = threading.Condition()
        self._waiting: SolveRequest | None = None
        self._jobs: deque[Job] = deque()
        self._stale, self._ended = True, False
        self.solved, self.dropped = 0, 0
        self._thread = threading.Thread(target=self._run, name="solver", daemon=True)
        self._thread.start()

    def ask(self, request: SolveRequest) -> None:
        """Solve this next, in place of what is waiting."""
        with self._wake:
            self.dropped += self._waiting is not None
            self._waiting = request
            self._wake.notify()

    def put(self, job: Job) -> None:
        """Run this in the thread, in the order of the calls."""
        with self._wake:
            self._jobs.append(job)
            self._wake.notify()

    def close(self) -> None:
        """End the thread after what it is doing."""
        with self._wake:
            self._ended = True
            self._wake.notify()
        self._thread.join()

    def _run(self) -> None:
        limit_process()
        while True:
            with self._wake:
                if not (self._ended or self._jobs or self._waiting):
                    self._wake.wait(QUIET if self._stale else None)
                if self._ended:
                    return
                job = self._jobs.popleft() if self._jobs else None
                request, self._waiting = (None, self._waiting) if job else (self._waiting, None)
            try:
                self._do(job, request)
            except Exception:  # a fault of one job must not leave a page that never answers again
                log.exception("the live page's solver met a fault that it should not")

    def _do(self, job: Job | None, request: SolveRequest | None) -> None:
        if job is not None:
            job()
        elif request is not None:
            self._session.solve(request)
            self.solved += 1
            self._stale = True
            self._answered(request)
        elif self._stale:
            self._stale = False
            self._quiet()
