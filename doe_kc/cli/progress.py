"""Progress on stderr: a bar with rate and time left in a terminal, lines elsewhere; of a correlation with the
best merit so far."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from doe_kc.correlation.problem import Evaluated

INTERVAL = 10.0
"""Seconds between two lines at least; the first and the last are always written."""
Tell = Callable[[str, int, int], None]
"""Told (what, steps done, of how many)."""


@contextmanager
def progress_bar(what: str, total: int) -> Iterator[Callable[[int], None]]:
    """A function that advances by so many steps."""
    with described_bar(what, total) as tell:
        done = 0

        def advance(steps: int) -> None:
            nonlocal done
            done += steps
            tell(what, done, total)

        yield advance


@contextmanager
def correlation_bar(budget: int) -> Iterator[Callable[[Sequence[Evaluated]], None]]:
    """A function that takes each round of evaluations, of `budget` at most."""
    best: list[Evaluated] = []
    done = 0

    def watch(tell: Tell, new: Sequence[Evaluated]) -> None:
        nonlocal done
        done += len(new)
        solved = [e for e in [*best, *new] if e.rating is not None]
        if solved:
            best[:] = [max(solved, key=lambda e: e.merit)]
        tell(_merit_words(best[0]) if best else "correlating", done, budget)

    with described_bar("correlating", budget) as tell:
        yield partial(watch, tell)


def _merit_words(best: Evaluated) -> str:
    return f"merit {best.merit:.4g} ({'feasible' if best.feasible else 'not feasible'})"


@contextmanager
def described_bar(what: str, total: int) -> Iterator[Tell]:
    """A function that says what is under way, how many steps are done, and of how many.

    A bar in a terminal; in a file or pipe a line at the start, then one every ten seconds, and at the end.
    """
    with _bar(what, total) if sys.stderr.isatty() else _lines(what, total) as tell:
        yield tell


@contextmanager
def _bar(what: str, total: int) -> Iterator[Tell]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        task = progress.add_task(what, total=total, rate="")

        def tell(words: str, done: int, of: int) -> None:
            speed = progress.tasks[0].speed
            rate = f"{speed:.3g}/s" if speed else ""
            progress.update(task, completed=done, total=of, description=words, rate=rate)

        yield tell


@contextmanager
def _lines(what: str, total: int) -> Iterator[Tell]:
    lines = ProgressLines(what, total, sys.stderr)
    yield lines.tell
    lines.close()


class ProgressLines:
    """Lines such as `correlating: rating -0.4 (feasible), 37 of 100 in 21 s`, not too many of them.

    clock: seconds, for tests.
    """

    def __init__(
        self, what: str, total: int, stream: TextIO, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._what, self._words, self._total = what, what, total
        self._stream, self._clock = stream, clock
        self._done = 0
        self._started = self._written = clock()
        self._write(f"{what}: {total} steps")

    def tell(self, words: str, done: int, total: int) -> None:
        """So many steps are done, of so many; written when the last line is ten seconds old."""
        self._words, self._done, self._total = words, done, total
        now = self._clock()
        if now - self._written >= INTERVAL:
            self._written = now
            self._write(self._state())

    def close(self) -> None:
        """The last line."""
        self._write(self._state())

    def _state(self) -> str:
        words = "" if self._words == self._what else f"{self._words}, "
        return f"{self._what}: {words}{self._done} of {self._total} in {self._clock() - self._started:.0f} s"

    def _write(self, line: str) -> None:
        self._stream.write(f"{line}\n")
        self._stream.flush()
