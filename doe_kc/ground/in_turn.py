"""Results in order, the next ones begun before the last is asked for."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future
from itertools import islice
from typing import TypeVar

A = TypeVar("A")
T = TypeVar("T")
AHEAD = 2
"""Results begun at once. Where a loop stops at the first of no use, further ones would be for nothing."""


def in_turn(function: Callable[[A], T], arguments: Iterable[A], pool: Executor | None) -> Iterator[T]:
    """`function` of each argument; in the threads of a pool AHEAD of them at once, without one each when it
    is asked for. Closed before its end, it begins with none of the others."""
    if pool is None:
        yield from map(function, arguments)
        return
    following = iter(arguments)
    begun: deque[Future[T]] = deque(pool.submit(function, a) for a in islice(following, AHEAD))
    try:
        while begun:
            result = begun.popleft().result()
            yield result
            begun.extend(pool.submit(function, a) for a in islice(following, 1))
    finally:
        for future in begun:
            future.cancel()
