"""Progress on stderr: a bar with rate and time left in a terminal, lines elsewhere; of a correlation with the
best merit so far."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import TextIO

from doe_kc.correlation.problem import Evaluated

INTERVAL = 10.0
"""Seconds between two lines at least; the first and the last are always written."""


@contextmanager
def progress_bar(what: str, total: int) -> Iterator[Callable[[int], None]]:
    """A function that advances by so many steps."""
    with described_bar(what, total) as advance:
        yield lambda steps: advance(steps, what)


@contextmanager
def correlation_bar(budget: int) -> Iterator[Callable[[Sequence[Evaluated]], None]]:
    """A function that takes each round of evaluations, of `budget` at most."""
    best: list[Evaluated] = []

    def watch(advance: Callable[[int, str], None], new: Sequence[Evaluated]) -> None:
        solved = [e for e in [*best, *new] if e.rating is not None]
        if solved:
            best[:] = [max(solved, key=lambda e: e.merit)]
        advance(len(new), _merit_words(best[0]) if best else "correlating")

    with described_bar("correlating", budget) as advance:
        yield partial(watch, advance)


def _merit_words(best: Evaluated) -> str:
    return f"merit {best.merit:.4g} ({'feasible' if best.feasible else 'not feasible'})"


@contextmanager
def described_bar(what: str, total: int) -> Iterator[Callable[[int, str], None]]:
    """A function that advances by so many steps and says what is under way.

    A bar in a terminal; in a file or pipe a line at the start, then one every ten seconds, and at the end.
    """
    with _bar(what, total) if sys.stderr.isatty() else _lines(what, total) as advance:
        yield advance


@contextmanager
def _bar(what: str, total: int) -> Iterator[Callable[[int, str], None]]:
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

        def advance(steps: int, words: str) -> None:
            speed = progress.tasks[0].speed
            progress.update(task, advance=steps, description=words, rate=f"{speed:.3g}/s" if speed else "")

        yield advance


@contextmanager
def _lines(what: str, total: int) -> Iterator[Callable[[int, str], None]]:
    lines = ProgressLines(what, total, sys.stderr)
    yield lines.advance
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

    def advance(self, steps: int, words: str) -> None:
        """So many steps more; written when the last line is ten seconds old."""
        self._done += steps
        self._words = words
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
