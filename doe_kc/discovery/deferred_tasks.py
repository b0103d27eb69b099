"""Tasks whose results are wanted at the end: begun where workers would be without work."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from itertools import islice
from typing import Any, Generic, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


class DeferredTask(Generic[T]):
    """A task that an executor begins when it is told to, at the latest when its result is asked for."""

    def __init__(self, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> None:
        self._submitted_to: Callable[[Executor], Future[T]] | None
        self._submitted_to = lambda executor: executor.submit(task, *args, **kwargs)
        self._future: Future[T] | None = None

    @property
    def waits(self) -> bool:
        """Whether it has not begun."""
        return self._future is None

    def begin(self, executor: Executor) -> Future[T]:
        """Its future, the same each time; what the task is given is let go."""
        if self._future is None:
            assert self._submitted_to is not None
            self._future = self._submitted_to(executor)
            self._submitted_to = None
        return self._future


def under_way(tasks: Sequence[DeferredTask[Any]], executor: Executor) -> set[Future[Any]]:
    """Of those that have begun, what is not done."""
    return {f for t in tasks if not t.waits and not (f := t.begin(executor)).done()}


def begin_some(tasks: Sequence[DeferredTask[Any]], executor: Executor, most: int) -> None:
    """Begin so many of those that wait that `most` are under way, in their order."""
    spare = most - len(under_way(tasks, executor))
    for task in islice((t for t in tasks if t.waits), max(0, spare)):
        task.begin(executor)
