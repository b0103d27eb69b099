"""What surrogates there are to fit: the models asked for, and the stored designs that they can learn from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.campaign.store import read_store
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.linearization import linearize
from doe_kc.ground.errors import InputError, RunError
from doe_kc.study import Study
from doe_kc.surrogates.designs import Designs, designs_in_space
from doe_kc.surrogates.models import SURROGATES, make
from doe_kc.surrogates.models.gp import FirstOrderTrend
from doe_kc.surrogates.models.gp_slopes import SlopeProcess
from doe_kc.surrogates.study import VALIDATION_DESIGNS, default_models, number_of_tasks
from doe_kc.true_solver.own import AxleSolver


@dataclass(frozen=True)
class Plan:
    """designs: of the store. models: ids to fit. steps: of the progress. trend: exact, at the start."""

    designs: Designs
    models: tuple[str, ...]
    steps: int
    trend: FirstOrderTrend | None = None


def plan_surrogates(study: Study, models: Sequence[str] = ()) -> Plan:
    """What there is to fit; InputError for an unknown model, or saying how many designs are missing."""
    names = tuple(dict.fromkeys(models or study.surrogates.models))
    for name in names:
        make(name, "--models" if models else f"{study.source}: surrogates")
    designs = _designs(study)
    needed = _needed(names, study.space.dimension)
    if len(designs.x) < needed:
        raise InputError(_too_few(study, designs, needed))
    trend = exact_start(study, designs) if not names or SlopeProcess.id in names else None
    if trend is None and names == (SlopeProcess.id,):
        raise InputError(
            f"{study.source}: surrogates: gp_slopes needs exact sensitivities at the start, which only the "
            "package's own solver gives, with slopes = true; take gp."
        )
    chosen = names or tuple(default_models(*designs.x.shape, slopes=trend is not None))
    steps = number_of_tasks(chosen, len(designs.x), study.surrogates.folds)
    return Plan(designs, chosen, steps, trend)


def exact_start(study: Study, designs: Designs) -> FirstOrderTrend | None:
    """Values and exact slopes of the characteristics at the space's start; None where they are not to be had.

    That is for an outside solver, by the study's word, or when the start has no equilibrium.
    """
    if study.solver.command or not study.surrogates.slopes:
        return None
    space, point = study.space, study.space.start
    try:
        values = AxleSolver(study.axle, study.windows, curves=False).evaluate(space.values(point))
        if values.failed:
            return None
        slope = linearize(study.axle, space, point, study.windows).characteristics
    except RunError:
        return None
    rows = [list(CHARACTERISTICS).index(c.id) for c in designs.characteristics]
    trend = FirstOrderTrend(point, np.array(values.characteristics)[rows], slope[rows])
    known = np.isfinite(trend.value).all() and np.isfinite(trend.slope).all()
    return trend if known else None


def _designs(study: Study) -> Designs:
    if not study.store.is_file():
        return Designs((), np.zeros((0, study.space.dimension)), np.zeros((0, 0)), 0, 0)
    with read_store(study.store) as store:
        return designs_in_space(store, study.space, study.axle, study.windows)


def _needed(names: Sequence[str], variables: int) -> int:
    """Designs for the least demanding of the models."""
    fewest = [SURROGATES[n]().fewest(variables) for n in names]
    return max(VALIDATION_DESIGNS, min(fewest, default=0))


def _too_few(study: Study, designs: Designs, needed: int) -> str:
    lost = [
        text.format(n=n)
        for n, text in (
            (designs.failed, "{n} failed"),
            (designs.elsewhere, "{n} of other variables or bounds"),
        )
        if n
    ]
    more = f" (besides {' and '.join(lost)})" if lost else ""
    n = max(needed, 2 * study.space.dimension)
    return (
        f"{study.store}: holds {len(designs.x)} designs of the study's variables{more}, surrogates need at "
        f"least {needed} and do well with {n}; run doe-kc sample {study.source} --n {n} first."
    )
