"""Influence: the normalized parameter-influence matrix of a study."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import Progress, as_study, step_counter
from doe_kc.ground.errors import InputError
from doe_kc.measurement import Measurement
from doe_kc.parameter_influence.relations import relations
from doe_kc.study import Study
from doe_kc.workflow.influence import StudyInfluence, influence_runs, study_influence, write_influence
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
        from doe_kc.reports.matrix_plot import draw_matrix_plot, matrix_size

        frame = self.to_frame()
        ax = axes_or_new(ax, matrix_size(frame))
        draw_matrix_plot(ax, frame, f"Parameter influence: {self.study.name}")
        return ax

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc influence` writes, workbook, pictures and tables in `out`/influence; the paths."""
        return write_influence(self.study, self.influence, Path(out) / "influence", workers=workers)


def influence(
    study: Study | str | PathLike[str], *, workers: int | None = None, progress: Progress | None = None
) -> InfluenceResult:
    """One-at-a-time influence of the study's parameters on the characteristics, exact derivatives beside, and
    the variables to use where the study has a measurement. Nothing is written.

    study: a `Study`, its file or its folder; `[influence] parameters` chooses the parameters. workers:
    processes, one per core by default. progress: called with (what, steps done, of how many).

    Raises InputError for a study or record that is wrong, RunError where the axle has no equilibrium.

    >>> result = kc.influence("examples/front_axle", workers=1)
    >>> float(result.to_frame()["vertical.bump_steer"].abs().max())
    100.0
    """
    chosen = as_study(study)
    records = None if chosen.measurement is None else study_measurement(chosen)
    return influence_of(chosen, records, workers=workers, progress=progress)


def influence_of(
    study: Study, measurement: Measurement | None, *, workers: int | None, progress: Progress | None
) -> InfluenceResult:
    """The same of records that are reduced already."""
    advance = step_counter(progress, "one at a time", influence_runs(study))
    return InfluenceResult(study, study_influence(study, measurement, workers=workers, progress=advance))
