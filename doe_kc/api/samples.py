"""Samples: a design of experiments, every design solved."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import Progress, as_study, step_counter, stored
from doe_kc.campaign.export import designs_frame
from doe_kc.campaign.record import StoredCurves
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import InputError, nearest
from doe_kc.study import Study
from doe_kc.variables import Space
from doe_kc.workflow.sample import SampleResult, reasons, run_sample, study_design, write_sample

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class SamplingResult(FrameResult):
    """Designs of a study's space and what the solver answers. sampled: design and outcomes."""

    study: Study
    sampled: SampleResult

    @property
    def space(self) -> Space:
        """The variables with their bounds, for `Surrogate(space=...)`."""
        return self.study.space

    def to_frame(self) -> pd.DataFrame:
        """One row a design: label, parameters (absolute, in their units), status, reason, characteristics in
        their units, seconds. The characteristics `static.toe` and `static.camber`, parameters too, are
        columns `result.static.toe` and `result.static.camber`. nan where the axle has no equilibrium."""
        frame = designs_frame(list(self.sampled.design.rows()), self.sampled.outcomes)
        frame.insert(0, "label", list(self.sampled.design.labels))
        return frame.rename_axis("design")

    @cached_property
    def _known(self) -> pd.DataFrame:
        """Characteristics of the solved designs, those that the solver answers."""
        import pandas as pd

        values = pd.DataFrame(
            [o.characteristics for o in self.sampled.outcomes], columns=list(CHARACTERISTICS)
        )
        solved = values[[not o.failed for o in self.sampled.outcomes]]
        return solved.dropna(axis="columns", how="all").dropna().rename_axis("design")

    @property
    def designs(self) -> pd.DataFrame:
        """X of a surrogate: one row a solved design, variables as columns, absolute, in their units."""
        import pandas as pd

        design = self.sampled.design
        frame = pd.DataFrame(design.values, columns=list(design.paths))
        return frame.loc[self._known.index, [p for p in design.paths if p in self.space.paths]]

    @property
    def responses(self) -> pd.DataFrame:
        """y of a surrogate: the characteristics of the same designs, ids as columns, in their units."""
        return self._known.copy()

    @property
    def lines(self) -> list[str]:
        """Method, counts, and why designs failed."""
        done = self.sampled
        head = f"{len(done.outcomes)} designs ({done.design.method}) of {self.space.dimension} variables"
        return [head, done.counts, *(f"{count} x {reason}" for count, reason in reasons(done.failed)[:3])]

    def plot(self, parameter: str, characteristic: str, ax: Axes | None = None) -> Axes:
        """A characteristic over a variable, one point a design; InputError for an unknown name."""
        from doe_kc.api.axes import axes_or_new
        from doe_kc.reports.drawing.style import PALETTE

        designs, responses = self.designs, self.responses
        for name, frame in ((parameter, designs), (characteristic, responses)):
            if name not in frame:
                raise InputError(f"{name!r} is not a column of the sample.{nearest(name, frame.columns)}")
        unit = next(v.unit for v in self.space.variables if v.path == parameter)
        entry = CHARACTERISTICS[characteristic]
        ax = axes_or_new(ax, (5.6, 4.2))
        ax.plot(designs[parameter], responses[characteristic], "o", ms=3, color=PALETTE["blue"], alpha=0.7)
        ax.set_xlabel(f"{parameter} [{unit}]")
        ax.set_ylabel(f"{entry.label} [{entry.unit}]")
        ax.set_title(f"{len(designs)} designs ({self.sampled.design.method})", fontsize="medium")
        ax.grid(color="#DDDDDD", lw=0.5)
        return ax

    def write(self, out: str | PathLike[str]) -> list[Path]:
        """designs.csv in `out`/sample, as `doe-kc sample`; returns the paths."""
        return write_sample(self.study, self.sampled, Path(out) / "sample")


def sample(
    study: Study | str | PathLike[str],
    n: int | None = None,
    *,
    method: str | None = None,
    out: str | PathLike[str] | None = None,
    extend: bool = False,
    curves: StoredCurves = "all",
    retry_failed: bool = False,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> SamplingResult:
    """Solve designs of the study's variables.

    n, method ("lhs", "sobol", "one_at_a_time", "full_factorial", "table"): in place of the study's own; its
    seed decides the designs. out: folder for what `doe-kc sample --out` writes, its store among it, whose
    designs are not run again; by default nothing is written (but an outside solver's answers always go to the
    study's store). extend: designs that the store in `out` has already count among the n, and only what is
    missing is drawn, to complete them. curves: what the store keeps of new designs beside characteristics:
    "all" curves, their "fit" to a tenth of what a rig resolves, or "none". retry_failed: run stored failures
    again. workers: processes, one per core by default. scheduler: address of a Dask scheduler. progress:
    called with (what, designs done, of how many).

    A design without equilibrium is a row with status "failed" and its reason. Raises InputError for an
    unknown method, a table that does not fit, or extend without `out` or with nothing to add, RunError when
    interrupted or the folder cannot be written.

    >>> result = kc.sample("examples/front_axle", 4, workers=1)
    >>> result.designs.shape[0], result.responses["vertical.bump_steer"].notna().all().item()
    (4, True)
    """
    chosen = as_study(study)
    if n is not None and n < 1:
        raise InputError(f"sample: n = {n}, expected 1 or more designs.")
    if extend and out is None and not chosen.solver.command:
        raise InputError("sample: extend = True without a store to complete; give its folder as out.")
    with stored(chosen, out) as kept:
        design = study_design(kept, method=method, n=n, extend=extend)
        sampled = run_sample(
            kept,
            design,
            workers=workers,
            scheduler=scheduler,
            retry_failed=retry_failed,
            stored_curves=curves,
            progress=step_counter(progress, design.method, len(np.atleast_2d(design.values))),
        )
    result = SamplingResult(chosen, sampled)
    if out is not None:
        result.write(out)
    return result
