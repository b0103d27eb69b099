"""Surrogates: fitted to a study's stored designs, cross-validated, chosen, influence read off them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.parameter_influence.study import influence_study
from doe_kc.study import Study
from doe_kc.surrogates.designs import Designs
from doe_kc.surrogates.influence import agreement, free_variables, surrogate_changes
from doe_kc.surrogates.report import SurrogateReport
from doe_kc.surrogates.shares import total_shares
from doe_kc.surrogates.study import fit_study
from doe_kc.workflow.surrogate_plan import Plan

Progress = Callable[[int], None]


@one_thread()
def run_surrogates(
    study: Study,
    plan: Plan,
    *,
    targets: Mapping[str, float] | None = None,
    workers: int | None = None,
    progress: Progress = lambda _: None,
) -> SurrogateReport:
    """Fits, judges, chooses, and reads influence off the chosen models.

    targets: characteristic -> measured value, shown in the figures.
    """
    fitted = fit_study(
        plan.designs.x,
        plan.designs.y,
        models=plan.models,
        folds=study.surrogates.folds,
        seed=study.seed,
        workers=workers,
        progress=progress,
        trend=plan.trend,
    )
    model, space = fitted.model, study.space
    changes = surrogate_changes(model, space)
    reference = one_at_a_time_changes(study, plan.designs, workers=workers)
    return SurrogateReport(
        space=space,
        designs=plan.designs,
        fitted=fitted,
        changes=changes,
        shares=total_shares(model, space, seed=study.seed),
        reference=reference,
        agreement=agreement(changes, reference),
        targets=dict(targets or {}),
    )


def one_at_a_time_changes(study: Study, designs: Designs, *, workers: int | None = None) -> FloatArray:
    """(d, m) by the package's own solver about the unchanged axle; nan where it cannot be compared.

    That is all of them for an outside solver, and variables that other parameters follow.
    """
    space = study.space
    out = np.full((space.dimension, len(designs.characteristics)), np.nan)
    free = free_variables(space)
    if study.solver.command or not free.any():
        return out
    rows = [v.parameter for v, f in zip(space.variables, free, strict=True) if f]
    found = influence_study(study.axle, rows, designs.characteristics, workers=workers, windows=study.windows)
    out[free] = found.absolute
    return out
