"""Surrogates: planned for a study's stored designs, fitted, cross-validated, chosen, written."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.campaign.store import read_store
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.correlation.linearization import linearize
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.output import write_csv
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import reduce_cars
from doe_kc.parameter_influence.study import influence_study
from doe_kc.reports.render.csv import table_frame
from doe_kc.reports.render.terminal import table_lines
from doe_kc.reports.surrogates import tables
from doe_kc.reports.surrogates.evaluator import write_evaluator
from doe_kc.reports.surrogates.figures import write_surrogate_figures
from doe_kc.reports.surrogates.learning import learning_document, learning_lines, learning_table
from doe_kc.reports.surrogates.workbook import write_surrogate_workbook
from doe_kc.study import Study
from doe_kc.surrogate_models.designs import Designs, designs_in_space
from doe_kc.surrogate_models.influence import agreement, free_variables, surrogate_changes
from doe_kc.surrogate_models.learning_curve import learning_curve
from doe_kc.surrogate_models.models import SURROGATES, make
from doe_kc.surrogate_models.models.gp import FirstOrderTrend
from doe_kc.surrogate_models.models.gp_slopes import SlopeProcess
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.surrogate_models.saved import save_surrogate
from doe_kc.surrogate_models.shares import total_shares
from doe_kc.surrogate_models.study import (
    VALIDATION_DESIGNS,
    default_folds,
    default_models,
    fit_study,
    model_of,
    number_of_tasks,
)
from doe_kc.true_solver.own import AxleSolver
from doe_kc.workflow.predict import saved_surrogate


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
    curve = learning_curve(
        {name: model_of(name, plan.trend) for name in fitted.models},
        fitted.chosen,
        fitted.x,
        fitted.y,
        q2=fitted.of_chosen({name: judged.quality.q2 for name, judged in fitted.models.items()}),
        folds=study.surrogates.folds or default_folds(len(fitted.x)),
        seed=study.seed,
        workers=workers,
    )
    changes = surrogate_changes(model, space)
    reference = one_at_a_time_changes(study, plan.designs, workers=workers)
    return SurrogateReport(
        space=space,
        designs=plan.designs,
        fitted=fitted,
        changes=changes,
        shares=total_shares(model, space, seed=study.seed, workers=workers),
        reference=reference,
        agreement=agreement(changes, reference),
        targets=dict(targets or {}),
        goal=study.surrogates.goal,
        curve=curve,
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
    influence = influence_study(
        study.axle, rows, designs.characteristics, workers=workers, windows=study.windows
    )
    out[free] = influence.absolute
    return out


def measured_values(study: Study) -> dict[str, float]:
    """Characteristic -> measured value, which the figures show; none without a measurement."""
    if study.measurement is None:
        return {}
    measured = reduce_cars(study.measurements, windows=study.windows, half_track=study.axle.half_track)
    values = {name: estimate.value for name, estimate in measured.characteristics.items()}
    return {name: value for name, value in values.items() if math.isfinite(value)}


def write_surrogates(
    study: Study, report: SurrogateReport, folder: Path, *, workers: int | None = None
) -> list[Path]:
    """surrogates.xlsx, surrogate.npz for `predict`, evaluators, CSV tables (quality, predictions, influence,
    shares, learning curve) and figures; their paths."""
    book = write_surrogate_workbook(
        folder / "surrogates.xlsx", report, study=study.name, date=date.today().isoformat()
    )
    frames = {
        "quality": table_frame(tables.quality_table(report)),
        "predictions": tables.predictions_frame(report),
        "influence": tables.matrix_frame(report, report.changes),
        "shares": tables.matrix_frame(report, report.shares),
    }
    if report.curve is not None:
        frames["learning_curve"] = table_frame(learning_table(report, report.curve))
    csv = [write_csv(folder / f"{name}.csv", frame) for name, frame in frames.items()]
    pictures = write_surrogate_figures(
        report, folder, study=study.name, workers=workers, pictures=study.pictures
    )
    surrogate = saved_surrogate(report, study=study.name)
    kept = [save_surrogate(folder / "surrogate.npz", surrogate)]
    if "quadratic" not in report.fitted.chosen:  # which has no formula of few lines
        kept += write_evaluator(folder / "evaluator", surrogate)
    return [book, *kept, *csv, *pictures]


def surrogates_document(report: SurrogateReport) -> dict[str, Any]:
    """`{"designs", "failed", "elsewhere", "chosen": {characteristic: model}, "models": {model: {"seconds",
    "characteristics": {characteristic: {"q2", "rmse", "unit", "coverage", "calibrated_coverage",
    "calibrated_low", "calibrated_high", "sharpness"}}}}, "skipped": {model: reason}, "influence":
    {characteristic: {parameter: change}}, "shares", "agreement", "goal", "designs_for_goal": {characteristic:
    {"designs", "low", "high", ...}}}`; the last is empty where half the designs are too few.
    """
    ids = [c.id for c in report.designs.characteristics]
    return {
        "designs": len(report.designs.x),
        "failed": report.designs.failed,
        "elsewhere": report.designs.elsewhere,
        "chosen": dict(zip(ids, report.fitted.chosen, strict=True)),
        "models": {
            name: {"seconds": judged.seconds, "characteristics": tables.quality_document(report, name)}
            for name, judged in report.fitted.models.items()
        },
        "skipped": report.fitted.skipped,
        "influence": tables.matrix_document(report, report.changes),
        "shares": tables.matrix_document(report, report.shares),
        "agreement": tables.agreement_document(report),
        "goal": report.goal,
        "designs_for_goal": learning_document(report),
    }


def surrogate_lines(report: SurrogateReport) -> list[str]:
    """For a terminal: the chosen model of every characteristic and its quality, then what was left out."""
    lines = table_lines(tables.chosen_table(report))
    lines += [f"{name}: {_average(report, name)}" for name in report.fitted.models]
    lines += [f"{name} left out: {reason}" for name, reason in report.fitted.skipped.items()]
    lines += learning_lines(report)
    r = report.agreement.correlation
    if np.isfinite(r).any():
        median, least = np.nanmedian(r), np.nanmin(r)
        lines.append(
            "influence at the unchanged axle against one at a time: correlation "
            f"{median:.3f} in the median, {least:.3f} at least"
        )
    lines.append(
        f"{len(report.designs.x)} designs, {report.designs.failed} failed and {report.designs.elsewhere} of "
        "other variables or bounds left out"
    )
    return lines


def _average(report: SurrogateReport, name: str) -> str:
    judged = report.fitted.models[name]
    q2 = judged.quality.q2
    used = sum(n == name for n in report.fitted.chosen)
    mean, worst = (float(f(q2)) if np.isfinite(q2).any() else math.nan for f in (np.nanmean, np.nanmin))
    return (
        f"Q2 {mean:.4f} in the mean, {worst:.4f} at worst, one fit {judged.seconds:.2f} s, "
        f"used for {used} of {len(report.fitted.chosen)}"
    )
