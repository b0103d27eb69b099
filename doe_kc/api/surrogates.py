"""Surrogates: fast models of every characteristic, of the designs that a study has stored."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import Progress, as_study, step_counter
from doe_kc.api.surrogate import Surrogate, fitted_surrogate
from doe_kc.reports.render.csv import table_frame
from doe_kc.reports.surrogates import tables
from doe_kc.study import Study
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.workflow.surrogates import (
    measured_values,
    plan_surrogates,
    run_surrogates,
    surrogate_lines,
    write_surrogates,
)

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class SurrogatesResult(FrameResult):
    """Surrogates of a study, cross-validated, the best kind chosen for each characteristic. report: designs,
    fits, and the influence and shares that are read off them."""

    study: Study
    report: SurrogateReport

    @cached_property
    def surrogate(self) -> Surrogate:
        """The chosen models as one fitted estimator: `predict(designs, return_std=True)`, `score`."""
        done, options = self.report, self.study.surrogates
        estimator = Surrogate(
            list(done.fitted.models), space=done.space, folds=options.folds, seed=self.study.seed
        )
        return fitted_surrogate(estimator, [c.id for c in done.designs.characteristics], done.fitted)

    @property
    def quality(self) -> pd.DataFrame:
        """One row a characteristic and kind: characteristic, model, chosen, q2 (1 = perfect, 0 = no better
        than the mean), rmse in `unit`, coverage of the 95 % interval before and after calibration, ..."""
        return table_frame(tables.quality_table(self.report))

    @property
    def influence(self) -> pd.DataFrame:
        """Change of every characteristic, in its unit, for a positive step of each parameter; parameter paths
        as index, ids as columns."""
        return tables.matrix_frame(self.report, self.report.changes).set_index("parameter")

    @property
    def shares(self) -> pd.DataFrame:
        """Total-effect shares of variance over the box of the variables, 0 to 1; shaped alike."""
        return tables.matrix_frame(self.report, self.report.shares).set_index("parameter")

    @property
    def predictions(self) -> pd.DataFrame:
        """One row a design and characteristic: true value, prediction with the design left out, its sd."""
        return tables.predictions_frame(self.report)

    def to_frame(self) -> pd.DataFrame:
        """`quality` of the chosen kinds, the characteristic's id as index."""
        frame = self.quality
        return frame[frame["chosen"]].drop(columns="chosen").set_index("characteristic")

    @property
    def lines(self) -> list[str]:
        """Designs, and the quality of each kind."""
        done = self.report
        head = f"{len(done.designs.x)} designs of {done.space.dimension} variables"
        names = tuple(done.fitted.models)
        return [head, *(line for line in surrogate_lines(done) if line.startswith(names))]

    def plot(self, characteristic: str | None = None, ax: Axes | None = None) -> Axes:
        """Left-out predictions over true values of a characteristic, by default the worst predicted one;
        InputError for an unknown id."""
        name = str(self.to_frame()["q2"].idxmin()) if characteristic is None else characteristic
        return self.surrogate.plot(name, ax)

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc surrogates` writes, workbook, tables and pictures in `out`/surrogates; the paths."""
        return write_surrogates(self.study, self.report, Path(out) / "surrogates", workers=workers)


def surrogates(
    study: Study | str | PathLike[str],
    models: Sequence[str] = (),
    *,
    out: str | PathLike[str] | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> SurrogatesResult:
    """Fit surrogates of every characteristic to the designs in the study's store, cross-validate and choose.

    models: ids of the kinds to choose from, as of `Surrogate`, by default the study's own. out: folder in
    whose store the designs are, as of `sample(out=...)`, and for what `doe-kc surrogates --out` writes; by
    default the study's store is read and nothing written. workers: processes, one per core by default.
    progress: called with (what, fits done, of how many).

    Raises InputError for an unknown kind, or where the store holds fewer designs than the kinds need.

    >>> sampling = kc.sample("examples/front_axle", 24, out="sampled", workers=1)
    >>> result = kc.surrogates("examples/front_axle", ["linear", "quadratic"], out="sampled", workers=1)
    >>> bool((result.to_frame()["q2"] > 0.9).all())
    True
    >>> result.surrogate.predict(sampling.designs.head(2)).shape == (2, sampling.responses.shape[1])
    True
    """
    chosen = as_study(study)
    kept = chosen if out is None else replace(chosen, out=Path(out))
    plan = plan_surrogates(kept, list(models))
    report = run_surrogates(
        kept,
        plan,
        targets=measured_values(kept),
        workers=workers,
        progress=step_counter(progress, "fit", plan.steps),
    )
    result = SurrogatesResult(chosen, report)
    if out is not None:
        result.write(out, workers=workers)
    return result
