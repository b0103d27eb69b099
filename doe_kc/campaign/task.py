"""One evaluation, in whatever process it runs: failure is a value."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from doe_kc.campaign.record import Packed, packed_outcome
from doe_kc.ground.errors import DoeKcError
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


def task_for(solver: TrueSolver) -> Task:
    """What to submit to an executor for each design."""
    return partial(run_one, solver)
