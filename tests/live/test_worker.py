"""The solver's thread: one in flight, one waiting; jobs in order; a fault of one is not the end."""

from __future__ import annotations

import threading
from typing import cast

import pytest

from doe_kc.live.model import LiveModel
from doe_kc.live.session import Session, SolveRequest
from doe_kc.live.worker import LiveWorker

PATIENCE = 30.0


class SlowSession:
    """Stands for a session whose solves wait until they are let go."""

    def __init__(self) -> None:
        self.begun, self.go = threading.Semaphore(0), threading.Semaphore(0)
        self.solved: list[int] = []

    def solve(self, request: SolveRequest) -> None:
        """Notes the request's number."""
        self.begun.release()
        assert self.go.acquire(timeout=PATIENCE)
        self.solved.append(request.seq)


def request(seq: int) -> SolveRequest:
    return SolveRequest(seq, cast(LiveModel, None), {})


def test_what_waits_is_replaced_by_what_is_newer() -> None:
    session, quiet, told = SlowSession(), threading.Event(), list[int]()
    worker = LiveWorker(cast(Session, session), lambda r: told.append(r.seq), quiet.set)
    worker.ask(request(1))
    assert session.begun.acquire(timeout=PATIENCE)  # in flight
    for seq in range(2, 50):
        worker.ask(request(seq))
    session.go.release(2)
    assert session.begun.acquire(timeout=PATIENCE)
    quiet.clear()
    assert quiet.wait(PATIENCE)
    worker.close()
    assert session.solved == told == [1, 49]
    assert (worker.solved, worker.dropped) == (2, 47)


def test_jobs_keep_their_order_and_a_fault_is_told(caplog: pytest.LogCaptureFixture) -> None:
    done, ended = list[str](), threading.Event()

    def fail() -> None:
        raise ValueError("broken job")

    worker = LiveWorker(cast(Session, SlowSession()), lambda r: None, lambda: None)
    for job in (lambda: done.append("a"), fail, lambda: done.append("b"), ended.set):
        worker.put(job)
    assert ended.wait(PATIENCE)
    worker.close()
    assert done == ["a", "b"] and "broken job" in caplog.text
