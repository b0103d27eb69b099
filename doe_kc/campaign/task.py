"""One evaluation, in whatever process it runs: failure is a value."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from concurrent.futures import Executor
from functools import lru_cache, partial

from doe_kc.campaign.in_process import InProcess
from doe_kc.campaign.record import Packed, packed_outcome
from doe_kc.errors import DoeKcError
from doe_kc.solver.result import NotConverged
from doe_kc.true_solver.outcome import checked, failure
from doe_kc.true_solver.protocol import TrueSolver, Values

Task = Callable[[Values], Packed]


def run_one(solver: TrueSolver, values: Values) -> Packed:
    """One design, packed. InputError, RunError and MemoryError end the campaign, all else is a failure."""
    try:
        outcome = checked(solver.evaluate(values))
    except NotConverged as error:
        outcome = failure(str(error))
    except (DoeKcError, MemoryError):
        raise
    except Exception as error:  # whatever an outside solver trips over
        outcome = failure(f"{solver.name} raised {type(error).__name__}: {error}")
    return packed_outcome(outcome)


def run_sent(solver: bytes, values: Values) -> Packed:
    """The same with a solver as it is sent to another process."""
    return run_one(_received(solver), values)


@lru_cache(maxsize=2)
def _received(solver: bytes) -> TrueSolver:
    """Cached: a pure function, and the next hundred designs come with the same solver."""
    found: TrueSolver = pickle.loads(solver)
    return found


def task_for(solver: TrueSolver, executor: Executor) -> Task:
    """What to submit to an executor for each design."""
    if isinstance(executor, InProcess):
        return partial(run_one, solver)
    return partial(run_sent, pickle.dumps(solver))
