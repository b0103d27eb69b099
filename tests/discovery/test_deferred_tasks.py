"""Tasks that wait until workers have nothing else to do."""

from __future__ import annotations

import weakref
from concurrent.futures import Executor, Future
from typing import Any

from doe_kc.campaign.executors import InProcess
from doe_kc.discovery.deferred_tasks import DeferredTask, begin_some, under_way


class Pending(Executor):
    """Tasks are done when the test says so."""

    def __init__(self) -> None:
        self.begun: list[Future[Any]] = []

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.fn = lambda: future.set_result(fn(*args, **kwargs))  # type: ignore[attr-defined]
        self.begun.append(future)
        return future

    def work(self, place: int) -> None:
        self.begun[place].fn()  # type: ignore[attr-defined]


def test_so_many_are_under_way_at_once_in_their_order() -> None:
    executor = Pending()
    tasks = [DeferredTask(executor, divmod, 10 * i, 7) for i in range(3)]
    assert begin_some(tasks, 0) == set()
    assert not executor.begun
    for _ in range(2):
        assert begin_some(tasks, 2) == set(executor.begun)
        assert [t.waits for t in tasks] == [False, False, True]
    assert under_way(tasks) == set(executor.begun)
    executor.work(0)
    assert under_way(tasks) == {executor.begun[1]}
    assert begin_some(tasks, 2) == set(executor.begun[1:])
    assert len(executor.begun) == 3
    executor.work(2)
    assert tasks[2].begin().result() == (2, 6)


def test_a_task_begins_once() -> None:
    executor = Pending()
    task = DeferredTask(executor, abs, -3.0)
    assert task.begin() is task.begin() and len(executor.begun) == 1


def test_what_a_task_is_given_goes_when_it_has_begun() -> None:
    """Derivatives of 7 MB each; the executor lets its own go."""
    given = Pending()
    here, task = weakref.ref(given), DeferredTask(InProcess(), id, given)
    del given
    assert here() is not None and task.begin().done()
    assert here() is None
