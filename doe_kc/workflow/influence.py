"""Influence: the study's parameter-influence matrix as workbook, pictures, tables and JSON."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from doe_kc.characteristics import appendix_c, characteristics_of
from doe_kc.correlation.options import ObjectiveKind
from doe_kc.ground.output import write_columns
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement
from doe_kc.parameter_influence.global_methods import GlobalMethod, find_global_method
from doe_kc.parameter_influence.global_sensitivity import GlobalSensitivity, global_sensitivity
from doe_kc.parameter_influence.relations import relations
from doe_kc.parameter_influence.selection import select_variables
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.parameter_influence.study import NONLINEAR_PERCENT, Influence, influence_study
from doe_kc.reports.influence.global_tables import global_document, global_table
from doe_kc.reports.influence.tables import strongest_table
from doe_kc.reports.influence.workbook import InfluenceBook
from doe_kc.reports.render.csv import table_columns
from doe_kc.reports.render.terminal import table_lines
from doe_kc.study import STORES, Study
from doe_kc.targets import Target, build_targets
from doe_kc.targets.comparison import constraint_interval

FORECAST_SHARE = 0.2
"""Of the constraint interval's half width: the error granted to a linear forecast of a target."""


@dataclass(frozen=True)
class StudyInfluence:
    """matrix: the columns of Appendix C that the axle has; everything: all that it has; selection: None
    without targets; overall: global sensitivities, None where none were asked for."""

    matrix: Influence
    everything: Influence
    selection: Selection | None
    overall: GlobalSensitivity | None = None


def study_influence(
    study: Study,
    measurement: Measurement | None,
    *,
    workers: int | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> StudyInfluence:
    """One-at-a-time and exact influence of the study's parameters, and the variables to use.

    The selection is made for the targets that a correlation of the study would work on: those measured or
    typed, but those that it takes out.
    """
    everything = influence_study(
        study.axle,
        study.parameters,
        characteristics_of(study.axle),
        workers=workers,
        windows=study.windows,
        progress=progress,
    )
    selection = None
    if measurement is not None:
        targets = build_targets(
            study.axle, measurement, study.characteristics, study.curves, source=str(study.source)
        )
        chosen = [t for t in targets.characteristics if _sought(t, study.correlation.objective)]
        values = {t.entry.id: t.value for t in chosen}
        if values:
            selection = select_variables(everything, values, sd={t.entry.id: _sd(t) for t in chosen})
    shown = [c for c in appendix_c() if c in everything.characteristics]
    return StudyInfluence(everything.only(shown), everything, selection)


def _sought(target: Target, objective: ObjectiveKind) -> bool:
    """Whether a correlation tries to reach the target."""
    if target.objective is not None and target.objective.goal != "target":
        return False
    return target.active or (objective == "measured" and not target.excluded)


def _sd(target: Target) -> float:
    """Standard error of a target, and beside it what a linear forecast may miss: 3 % of the target."""
    low, high = constraint_interval(target.value)
    return math.hypot(target.sd, (high - low) / 2.0 * FORECAST_SHARE)


def study_methods(study: Study, asked: Sequence[str] | None) -> dict[GlobalMethod, int]:
    """Methods of global sensitivity with their sizes: `asked`, or those of the study; InputError for an
    unknown one."""
    options = study.influence
    names = options.methods if asked is None else asked
    source = f"{study.source}: influence.global" if asked is None else "--global"
    return {find_global_method(n, source): int(getattr(options, n)) for n in dict.fromkeys(names)}


def global_store(study: Study) -> Path:
    """The file of the designs of global sensitivities: apart from the study's own, which surrogates learn
    from."""
    return study.out / STORES / "global.sqlite"


def study_global(
    study: Study,
    methods: Mapping[GlobalMethod, int],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> GlobalSensitivity | None:
    """Global sensitivities of the study's variables over their ranges; None without a method."""
    if not methods:
        return None
    return global_sensitivity(
        study.axle,
        study.space,
        characteristics_of(study.axle),
        methods,
        seed=study.seed,
        store=global_store(study),
        windows=study.windows,
        workers=workers,
        scheduler=scheduler,
        progress=progress,
    )


def influence_lines(matrix: Influence) -> list[str]:
    """Strongest parameters of every characteristic, and what went wrong, for a terminal."""
    nonlinear = int(matrix.nonlinear.sum())
    return [
        *table_lines(strongest_table(relations(matrix))),
        *(f"{path}: {reason}" for path, reason in matrix.failures.items()),
        f"{len(matrix.parameters)} parameters x {len(matrix.characteristics)} characteristics in "
        f"{matrix.seconds:.1f} s; {nonlinear} entries differ from the exact sensitivity by more than "
        f"{NONLINEAR_PERCENT:g} %",
    ]


def influence_runs(study: Study) -> int:
    """Number of true-solver runs of the study, for progress."""
    return 1 + 2 * len(study.parameters)


def write_influence(
    study: Study, study_influence: StudyInfluence, folder: Path, *, workers: int | None = None
) -> list[Path]:
    """influence.xlsx, report.html, heat map and top-ten bars, and the three matrices as CSV."""
    matrix = study_influence.matrix
    book = InfluenceBook(
        matrix,
        relations=relations(matrix),
        study=study.name,
        date=date.today().isoformat(),
        selection=study_influence.selection,
        notes={
            "Axle": study.axle_words,
            "Selection": "sd of a difference: standard error of the target and 3 % of it, combined",
            "Effects": ", ".join(study.axle.effects) or "none",
        },
        windows=study.windows,
        overall=study_influence.overall,
    ).write(folder / "influence.xlsx")
    tables = {"percent": matrix.percent, "absolute": matrix.absolute, "exact": matrix.exact}
    csv = [
        write_columns(folder / f"influence_{name}.csv", matrix.columns(values))
        for name, values in tables.items()
    ]
    if study_influence.overall is not None:
        columns = table_columns(global_table(study_influence.overall, every=True))
        csv.append(write_columns(folder / "influence_global.csv", columns))
    from doe_kc.reports.page.influence import write_influence_page
    from doe_kc.reports.page.links import link_pages

    page = write_influence_page(
        folder / "report.html",
        matrix,
        study=study.name,
        axle=study.axle_words,
        date=date.today().isoformat(),
        labels=study.axle.labels,
        overall=study_influence.overall,
    )
    link_pages(folder.parent)
    if study.pictures == "none":
        return [book, page, *csv]
    from doe_kc.reports.influence.figures import write_influence_figures

    pictures = write_influence_figures(
        matrix,
        folder,
        study=study.name,
        workers=workers,
        pictures=study.pictures,
        overall=study_influence.overall,
    )
    return [book, page, *pictures, *csv]


def influence_document(influence: Influence, overall: GlobalSensitivity | None = None) -> dict[str, Any]:
    """`{"percent": {characteristic: {parameter: number}}, "absolute": ..., "exact": ..., "seconds"}`; with
    global sensitivities also `"global"`: method -> index -> `"value"` and `"error"`, likewise, and
    `"not_linear"`."""
    tables = {"percent": influence.percent, "absolute": influence.absolute, "exact": influence.exact}
    document: dict[str, Any] = {
        name: _by_characteristic(influence, values) for name, values in tables.items()
    }
    steps = {p.path: p.step for p in influence.parameters}
    if overall is not None:
        document["global"] = global_document(overall)
    return document | {"steps": steps, "failures": influence.failures, "seconds": influence.seconds}


def _by_characteristic(influence: Influence, values: FloatArray) -> dict[str, dict[str, float]]:
    columns = influence.columns(values)
    paths = columns.pop("parameter")
    return {ident: dict(zip(paths, column.tolist(), strict=True)) for ident, column in columns.items()}
