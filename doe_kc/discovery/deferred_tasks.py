"""Tasks whose results are wanted at the end: begun where workers would be without work."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from itertools import islice
from typing import Any, Generic, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


class DeferredTask(Generic[T]):
    """A task of an executor that begins when it is told to."""

    def __init__(self, executor: Executor, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> None:
        self._submit: Callable[[], Future[T]] | None = lambda: executor.submit(task, *args, **kwargs)
        self._future: Future[T] | None = None

    @property
    def waits(self) -> bool:
        """Whether it has not begun."""
        return self._future is None

    def begin(self) -> Future[T]:
        """Its future, the same each time; what the task is given is let go."""
        submit, self._submit = self._submit, None
        if submit is not None:
            self._future = submit()
        assert self._future is not None
        return self._future


def under_way(tasks: Sequence[DeferredTask[Any]]) -> set[Future[Any]]:
    """Of those that have begun, what is not done."""
    return {t.begin() for t in tasks if not t.waits and not t.begin().done()}


def begin_some(tasks: Sequence[DeferredTask[Any]], most: int) -> set[Future[Any]]:
    """Begin those that wait, in their order, until so many are under way; these."""
    spare = max(0, most - len(under_way(tasks)))
    return {task.begin() for task in islice((t for t in tasks if t.waits), spare)} | under_way(tasks)
