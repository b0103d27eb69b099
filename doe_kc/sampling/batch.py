"""True-solver evaluations of many designs, in this process or over worker processes."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from functools import partial

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import with_values
from doe_kc.characteristics import CHARACTERISTICS, reduce_all
from doe_kc.errors import RunError
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import library_for, solve
from doe_kc.solver.topology import Topology
from doe_kc.typing import FloatArray

CHUNK = 8
COMPILE_FROM = 50
"""Designs of one topology from which compiling it, some seconds, pays."""
Values = dict[str, float]
Windows = Mapping[str, float] | None


@dataclass(frozen=True)
class Evaluation:
    """characteristics: (n_char,) in the order of the registry, nan after a failure; reason: why, or empty."""

    characteristics: FloatArray
    reason: str


def evaluate(
    axle: Axle, values: Values, windows: Windows = None, compiled: frozenset[Topology] = frozenset()
) -> Evaluation:
    """One design: failure is a value. compiled: topologies to run compiled where that is possible."""
    changed = with_values(axle, values)
    solution = solve(changed, throw=False, compiled=None if changed.topology in compiled else False)
    if solution.failure is not None:
        return Evaluation(np.full(len(CHARACTERISTICS), np.nan), str(solution.failure))
    return Evaluation(np.array(list(reduce_all(curve_set(solution), windows).values())), "")


def evaluate_all(
    axle: Axle,
    designs: Sequence[Values],
    *,
    workers: int | None = None,
    windows: Windows = None,
    progress: Callable[[int], None] = lambda _: None,
) -> list[Evaluation]:
    """Every design, in order; `progress` is told how many more are done.

    workers: processes, default one per core; 1 stays in this process. windows: as in `reduce_all`.
    """
    count = workers if workers is not None else available_cores()
    compiled = worth_compiling(axle, designs)
    if count <= 1 or len(designs) < 2 * CHUNK:
        results = []
        for values in designs:
            results.append(evaluate(axle, values, windows, compiled))
            progress(1)
        return results
    for topology in compiled:
        library_for(topology, None)
    task = partial(_chunk, axle, windows, compiled)
    return list(_in_processes(task, designs, count, progress))


def worth_compiling(axle: Axle, designs: Sequence[Values]) -> frozenset[Topology]:
    """The axle's own topology, and those that enough designs switch to (a strut made flexible)."""
    count = Counter(with_values(axle, values).topology for values in designs)
    return frozenset({axle.topology} | {t for t, n in count.items() if n >= COMPILE_FROM})


def available_cores() -> int:
    """Cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def _in_processes(
    task: Callable[[list[Values]], list[Evaluation]],
    designs: Sequence[Values],
    workers: int,
    progress: Callable[[int], None],
) -> Iterator[Evaluation]:
    chunks = [list(designs[i : i + CHUNK]) for i in range(0, len(designs), CHUNK)]
    with ProcessPoolExecutor(
        workers, mp_context=start_context(), initializer=_leave_interrupts_to_parent
    ) as pool:
        futures = [pool.submit(task, chunk) for chunk in chunks]
        try:
            for future in futures:
                results = future.result()
                progress(len(results))
                yield from results
        except BrokenProcessPool:
            raise RunError(
                "a worker process was ended from outside, often for lack of memory; use fewer --workers."
            ) from None
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def start_context() -> multiprocessing.context.BaseContext:
    """Fork on Linux, where it is safe: workers inherit the assembled equations; spawn elsewhere."""
    return multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")


def _leave_interrupts_to_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _chunk(
    axle: Axle, windows: Windows, compiled: frozenset[Topology], designs: list[Values]
) -> list[Evaluation]:
    return [evaluate(axle, values, windows, compiled) for values in designs]
