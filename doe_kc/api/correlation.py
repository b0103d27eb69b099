"""Correlation: the axle tuned to the measured car."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np

from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import Progress, as_study, step_counter, stored
from doe_kc.axle import Axle
from doe_kc.correlation.assessment import Assessment, assess
from doe_kc.correlation.problem import Evaluated
from doe_kc.correlation.result import Correlation
from doe_kc.correlation.status import Status
from doe_kc.measurement import Measurement
from doe_kc.reports.correlation.characteristics import characteristic_rows, characteristic_table
from doe_kc.reports.correlation.evaluations import evaluation_table
from doe_kc.reports.correlation.parameters import parameter_table
from doe_kc.reports.correlation.terms import curve_table
from doe_kc.reports.render.csv import table_frame
from doe_kc.study import Study
from doe_kc.workflow.correlate import CorrelationChoices
from doe_kc.workflow.correlate import correlate as run_correlation
from doe_kc.workflow.measure import Reduced, study_records
from doe_kc.workflow.rebuild import write_run
from doe_kc.workflow.write_correlation import write_correlation

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class CorrelationResult(FrameResult):
    """A finished correlation. correlation: problem, evaluations, posterior; measurement: the reduced records,
    None with typed targets only; assessment: whether the axle can be used."""

    study: Study
    correlation: Correlation
    assessment: Assessment
    measurement: Measurement | None

    @property
    def status(self) -> Status:
        """sound, doubtful or not_usable."""
        return self.assessment.status

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why, in sentences; for a sound axle what was checked."""
        return self.assessment.reasons

    @property
    def axle(self) -> Axle:
        """The correlated axle."""
        return self.correlation.axle

    @cached_property
    def characteristics(self) -> pd.DataFrame:
        """One row a characteristic with a target, its id as index: unit, target, target_sd, baseline, final,
        low, high, inside, improvement_percent, ... in `unit`."""
        return table_frame(characteristic_table(self.correlation)).set_index("id")

    @cached_property
    def parameters(self) -> pd.DataFrame:
        """One row a parameter, its path as index: unit, baseline, final, lower, upper, sd of the posterior,
        at_bound, visible, ... absolute in `unit`."""
        return table_frame(parameter_table(self.correlation)).set_index("path")

    @property
    def curves(self) -> pd.DataFrame:
        """One row a measured curve with its RMS deviation before and after."""
        return table_frame(curve_table(self.correlation))

    @property
    def evaluations(self) -> pd.DataFrame:
        """One row a true-solver evaluation, in their order."""
        return table_frame(evaluation_table(self.correlation))

    def to_frame(self) -> pd.DataFrame:
        """`characteristics`."""
        return self.characteristics

    @property
    def lines(self) -> list[str]:
        """Status, and what was done."""
        done = self.correlation
        inside = int(self.characteristics["inside"].sum())
        return [
            self.assessment.line,
            f"{inside} of {len(self.characteristics)} characteristics inside their interval, "
            f"mean improvement {done.mean_improvement:.1f} %",
            f"{done.method}, {len(done.run.evaluated)} evaluations of {done.problem.space.dimension} "
            f"variables, {done.seconds:.1f} s",
        ]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Every characteristic before and after, in half widths of its interval: within +-1 is met."""
        from doe_kc.api.deviation_plot import draw_deviations
        from doe_kc.reports.drawing.style import BASELINE_COLOUR, FINAL_COLOUR

        rows = characteristic_rows(self.correlation)
        half = np.array([(r.interval[1] - r.interval[0]) / 2.0 for r in rows])
        target = np.array([r.entry.target.value for r in rows])
        before, after = (np.array([getattr(r.entry, when) for r in rows]) for when in ("baseline", "final"))
        series = {
            "baseline": ((before - target) / half, BASELINE_COLOUR),
            "final": ((after - target) / half, FINAL_COLOUR),
        }
        return draw_deviations([r.id for r in rows], series, ax)

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc correlate` writes, in `out`/correlate: axle file, tables, workbook, page, pictures;
        returns the paths. `doe-kc report` needs the store beside, which `correlate(out=...)` keeps."""
        return write_correlation(
            replace(self.study, out=Path(out)),
            self.correlation,
            self.measurement,
            Path(out) / "correlate",
            assessment=self.assessment,
            workers=workers,
        )


class CorrelatedAxle(FrameResult):
    """A result that hands over one axle: what its correlation says of it."""

    @property
    @abstractmethod
    def correlation(self) -> CorrelationResult:
        """Of the axle that is handed over."""

    @property
    def status(self) -> Status:
        """sound, doubtful or not_usable."""
        return self.correlation.status

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why, in sentences; for a sound axle what was checked."""
        return self.correlation.reasons

    @property
    def axle(self) -> Axle:
        """The axle to use: with the effects that were adopted, correlated."""
        return self.correlation.axle

    @property
    def characteristics(self) -> pd.DataFrame:
        """As `CorrelationResult.characteristics`."""
        return self.correlation.characteristics

    @property
    def parameters(self) -> pd.DataFrame:
        """As `CorrelationResult.parameters`."""
        return self.correlation.parameters

    def to_frame(self) -> pd.DataFrame:
        """`characteristics`."""
        return self.characteristics

    def plot(self, ax: Axes | None = None) -> Axes:
        """As `CorrelationResult.plot`."""
        return self.correlation.plot(ax)


def correlate(
    study: Study | str | PathLike[str],
    *,
    method: str | None = None,
    budget: int | None = None,
    out: str | PathLike[str] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> CorrelationResult:
    """Tune the study's variables to the measured car; every candidate is confirmed by the true solver.

    What the axle may lack is not looked for: `run` does that first. method ("ego", "gauss_newton", "pareto",
    "hybrid"), budget (true-solver evaluations): in place of the study's own. out: folder for what
    `doe-kc correlate --out` writes, its store among it, whose evaluations are not run again; by default
    nothing is written (but an outside solver's answers always go to the study's store). workers: processes,
    one per core by default. scheduler: address of a Dask scheduler. progress: called with (what, evaluations
    done, of how many at most).

    A result that is not usable is returned like any other: look at `status`. Raises InputError for a study,
    record or method that is wrong, RunError where the axle has no equilibrium.

    >>> result = kc.correlate("examples/front_axle", method="gauss_newton", budget=5, workers=1)
    >>> result.status in ("sound", "doubtful", "not_usable"), len(result.reasons) > 0
    (True, True)
    >>> result.characteristics.loc["static.toe", ["target", "final"]].shape
    (2,)
    """
    chosen = as_study(study)
    reduced = study_records(chosen)
    with stored(chosen, out) as kept:
        result = correlation_of(
            kept, reduced, progress, method=method, budget=budget, workers=workers, scheduler=scheduler
        )
    if out is not None:
        write_run(result.correlation, Path(out) / "correlate")
        result.write(out, workers=workers)
    return replace(result, study=chosen)


def correlation_of(
    study: Study,
    reduced: Reduced | None,
    progress: Progress | None,
    **choices: Unpack[CorrelationChoices],
) -> CorrelationResult:
    """The same of records that are reduced already, with effects adopted before."""
    advance = step_counter(progress, "correlating", choices.get("budget") or study.correlation.budget)

    def watch(new: Sequence[Evaluated]) -> None:
        advance(len(new))

    correlation = run_correlation(study, reduced, watch=watch, **choices)
    measurement = None if reduced is None else reduced.measurement
    return CorrelationResult(study, correlation, assess(correlation), measurement)
