"""Influence: the normalized parameter-influence matrix of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import Progress, as_study, step_counter, stored
from doe_kc.ground.errors import InputError
from doe_kc.measurement import Measurement
from doe_kc.parameter_influence.global_sensitivity import global_runs
from doe_kc.parameter_influence.relations import relations
from doe_kc.study import Study
from doe_kc.workflow.influence import (
    StudyInfluence,
    influence_runs,
    study_global,
    study_influence,
    study_methods,
    write_influence,
)
from doe_kc.workflow.measure import study_measurement

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

InfluenceKind = Literal["percent", "absolute", "exact"]


@dataclass(frozen=True, repr=False, eq=False)
class InfluenceResult(FrameResult):
    """The influence study of one axle. influence: `matrix` of the 21 characteristics of the published one,
    `everything` of all 30, `selection` of variables for the measured differences."""

    study: Study
    influence: StudyInfluence

    def to_frame(self, kind: InfluenceKind = "percent", *, every: bool = False) -> pd.DataFrame:
        """Parameter paths as index, characteristic ids as columns.

        percent: of the largest magnitude in the column, + where the characteristic rises with the
        parameter. absolute: change for the parameter's step (+1 mm, +10 %), unit of the characteristic.
        exact: derivative times that step. every: all 30 characteristics, not the 21 of the published matrix.
        nan where an axle has no equilibrium.
        """
        table = self.influence.everything if every else self.influence.matrix
        if kind not in ("percent", "absolute", "exact"):
            raise InputError(f"kind {kind!r}: expected percent, absolute or exact.")
        return table.frame(getattr(table, kind)).rename_axis("parameter")

    @property
    def selection(self) -> pd.DataFrame | None:
        """One row a parameter, its path as index, in the order of choice: verdict and numbers behind it; None
        without a measurement."""
        chosen = self.influence.selection
        return None if chosen is None else chosen.to_frame().set_index("parameter")

    def overall(self, method: str) -> pd.DataFrame:
        """Global sensitivities by one method, one row a variable and characteristic: the method's indices
        with the half widths of their 95 % intervals (`_error`), `effect` and `share` by the slopes.

        InputError for a method that was not asked for.
        """
        import numpy as np
        import pandas as pd

        done = self.influence.overall
        known = [] if done is None else [m.id for m in done.methods]
        if done is None or method not in known:
            raise InputError(f"{method!r} was not among the methods; known are {', '.join(known) or 'none'}.")
        (result,) = [m for m in done.methods if m.id == method]
        size = len(done.characteristics)
        columns = {
            "variable": np.repeat([v.path for v in done.variables], size),
            "characteristic": [c.id for c in done.characteristics] * len(done.variables),
            "effect": done.effects.ravel(),
            "share": done.shares.ravel(),
        }
        for index in result.indices:
            columns |= {index.id: index.values.ravel(), f"{index.id}_error": index.error.ravel()}
        return pd.DataFrame(columns)

    @property
    def not_linear(self) -> list[str]:
        """What slopes miss of a variable over its range, in sentences, the largest first; none without global
        sensitivities."""
        done = self.influence.overall
        return [] if done is None else [d.sentence for d in done.disagreements()]

    @property
    def failures(self) -> dict[str, str]:
        """Parameter path -> reason, of steps at which the axle has no equilibrium."""
        return dict(self.influence.matrix.failures)

    @property
    def lines(self) -> list[str]:
        """Size, and the strongest parameter of the first characteristics."""
        matrix = self.influence.matrix
        size = f"{len(matrix.parameters)} parameters x {len(matrix.characteristics)} characteristics"
        strongest = [
            f"{entry.characteristic.id}: "
            + ", ".join(f"{k.parameter} {k.percent:+.0f} %" for k in entry.links[:3])
            for entry in relations(matrix).by_characteristic[:3]
        ]
        return [f"{self.study.axle.name}, {size}", *strongest]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Heat map of the percent matrix, blue negative, orange positive, numbers from 5 % on."""
        from doe_kc.api.axes import axes_or_new
        from doe_kc.reports.drawing.matrix_plot import draw_matrix_plot, matrix_size

        frame = self.to_frame()
        ax = axes_or_new(ax, matrix_size(frame))
        draw_matrix_plot(ax, frame, f"Parameter influence: {self.study.name}")
        return ax

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc influence` writes, workbook, pictures and tables in `out`/influence; the paths."""
        return write_influence(self.study, self.influence, Path(out) / "influence", workers=workers)


def influence(
    study: Study | str | PathLike[str],
    *,
    methods: Sequence[str] | Mapping[str, int] | None = None,
    out: str | PathLike[str] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> InfluenceResult:
    """One-at-a-time influence of the study's parameters on the characteristics, exact derivatives beside, and
    the variables to use where the study has a measurement.

    study: a `Study`, its file or its folder; `[influence] parameters` chooses the parameters. methods: global
    sensitivities over the ranges of the study's variables ("morris", "sobol", "pawn"), by name or with their
    sizes (trajectories, base samples, designs), in place of those of the study. out: folder for what
    `doe-kc influence --out` writes, with the store of their designs; by default nothing is written. workers:
    processes, one per core by default. scheduler: address of a Dask scheduler, for the global designs.
    progress: called with (what, steps done, of how many).

    Raises InputError for a study or record that is wrong, an unknown method or one whose extra is missing,
    RunError where the axle has no equilibrium.

    >>> result = kc.influence("examples/front_axle", workers=1)
    >>> float(result.to_frame()["vertical.bump_steer"].abs().max())
    100.0
    """
    chosen = as_study(study)
    sizes = study_methods(chosen, None if methods is None else list(methods))
    if isinstance(methods, Mapping):
        sizes = {method: methods[method.id] for method in sizes}
    records = None if chosen.measurement is None else study_measurement(chosen)
    result = influence_of(chosen, records, workers=workers, progress=progress)
    with stored(chosen, out) as kept:
        counter = step_counter(progress, "global", global_runs(sizes, chosen.space.dimension))
        overall = study_global(kept, sizes, workers=workers, scheduler=scheduler, progress=counter)
    result = InfluenceResult(chosen, replace(result.influence, overall=overall))
    if out is not None:
        result.write(out, workers=workers)
    return result


def influence_of(
    study: Study, measurement: Measurement | None, *, workers: int | None, progress: Progress | None
) -> InfluenceResult:
    """The same of records that are reduced already."""
    advance = step_counter(progress, "one at a time", influence_runs(study))
    return InfluenceResult(study, study_influence(study, measurement, workers=workers, progress=advance))
