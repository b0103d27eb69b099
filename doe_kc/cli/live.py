"""Progress of a correlation on stderr: evaluations, the best rating so far, rate and time left."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from doe_kc.cli.progress import described_bar
from doe_kc.correlation.problem import Evaluated


@contextmanager
def live_rating(budget: int) -> Iterator[Callable[[Sequence[Evaluated]], None]]:
    """A function that is told of each round of evaluations."""
    best: list[Evaluated] = []

    def watch(advance: Callable[[int, str], None], new: Sequence[Evaluated]) -> None:
        solved = [e for e in [*best, *new] if e.rating is not None]
        if solved:
            best[:] = [max(solved, key=lambda e: e.merit)]
        advance(len(new), _words(best[0]) if best else "correlating")

    with described_bar("correlating", budget) as advance:
        yield partial(watch, advance)


def _words(best: Evaluated) -> str:
    return f"merit {best.merit:.4g} ({'feasible' if best.feasible else 'not feasible'})"
