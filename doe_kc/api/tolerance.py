"""Tolerance: what the production scatter of an axle's parameters does to its characteristics."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import Progress, as_study, step_counter, stored
from doe_kc.ground.errors import InputError, nearest
from doe_kc.production_scatter.options import FEWEST_CARS
from doe_kc.production_scatter.result import Tolerance
from doe_kc.reports.render.csv import table_frame
from doe_kc.reports.tolerance.scatter import band_table, scatter_table
from doe_kc.reports.tolerance.tables import car_columns, tightening_table, tolerance_table
from doe_kc.reports.tolerance.words import conclusions
from doe_kc.study import Study
from doe_kc.workflow.tolerance import study_tolerance, write_tolerance

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

SHOWN_BINS = 40


@dataclass(frozen=True, repr=False, eq=False)
class ToleranceResult(FrameResult):
    """The cars of one study and what their scatter comes from. tolerance: arrays behind the frames."""

    study: Study
    tolerance: Tolerance

    def to_frame(self) -> pd.DataFrame:
        """One row a characteristic, its id as index: nominal, mean, sd, first_order_sd, explained (share of
        the variance that slopes explain), percentiles, low, high, outside with its 95 % interval (shares in
        [0, 1]), measured values and the percent of the cars below them."""
        return table_frame(tolerance_table(self.tolerance)).set_index("name")

    def contributions(self, kind: Literal["first_order", "total"] = "total") -> pd.DataFrame:
        """Parameter paths as index, characteristic ids as columns: share of the variance, both sides
        together.

        first_order: by exact slopes with the correlations, adding up to 1. total: from the cars, curvature
        and interactions among it.
        """
        import pandas as pd

        if kind not in ("first_order", "total"):
            raise InputError(f"kind {kind!r}: expected first_order or total.")
        done = self.tolerance
        values = done.first_shares if kind == "first_order" else done.totals.shares
        paths = pd.Index([s.parameter.path for s in done.model.scatters], name="parameter")
        return pd.DataFrame(values, index=paths, columns=[c.id for c in done.characteristics])

    @property
    def tightening(self) -> pd.DataFrame:
        """One row a parameter, the one that brings most first: cars outside now, with half and with twice its
        scatter, the characteristic that gains most."""
        return table_frame(tightening_table(self.tolerance)).set_index("path")

    @property
    def scatter(self) -> pd.DataFrame:
        """One row a parameter: what was assumed of it."""
        return table_frame(scatter_table(self.tolerance)).set_index("path")

    @property
    def bands(self) -> pd.DataFrame:
        """One row a curve and wheel: widest place of the band of 95 % of the cars, share of each measured
        curve within it."""
        return table_frame(band_table(self.tolerance))

    @property
    def cars(self) -> pd.DataFrame:
        """One row a car: deviations by path, then characteristics."""
        return car_columns(self.tolerance)

    @property
    def lines(self) -> list[str]:
        """What follows, in sentences."""
        return [self.study.axle.name, *conclusions(self.tolerance)]

    def plot(self, characteristic: str | None = None, ax: Axes | None = None) -> Axes:
        """Distribution of one characteristic (by default the one with most cars outside), its requirement and
        the measured cars; InputError for one that is not there."""
        import numpy as np

        from doe_kc.api.axes import axes_or_new
        from doe_kc.reports.drawing.style import PALETTE

        rows = {s.entry.id: k for k, s in enumerate(self.tolerance.scatters)}
        if characteristic is not None and characteristic not in rows:
            raise InputError(
                f"{characteristic!r} is not among the characteristics.{nearest(characteristic, rows)}"
            )
        outside = [s.outside.share if s.outside is not None else -1.0 for s in self.tolerance.scatters]
        k = int(np.argmax(outside)) if characteristic is None else rows[characteristic]
        scatter, values = self.tolerance.scatters[k], self.tolerance.values[:, k]
        ax = axes_or_new(ax, (6.0, 4.0))
        ax.hist(values, bins=SHOWN_BINS, density=True, color=PALETTE["sky"], label="cars")
        ax.axvline(scatter.nominal, ls=":", color="black", label="unchanged axle")
        if scatter.requirement is not None:
            for limit in (scatter.requirement.low, scatter.requirement.high):
                if np.isfinite(limit):
                    ax.axvline(limit, color="black", lw=1.0)
        for name, (value, _) in scatter.measured.items():
            ax.axvline(value, color=PALETTE["vermillion"], label=f"measured: {name}")
        ax.set_xlabel(f"{scatter.entry.label} [{scatter.entry.unit}]")
        ax.set_title(scatter.entry.id)
        ax.legend(fontsize="small")
        return ax

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc tolerance` writes, in `out`/tolerance; returns the paths."""
        return write_tolerance(self.study, self.tolerance, Path(out) / "tolerance", workers=workers)


def tolerance(
    study: Study | str | PathLike[str],
    samples: int | None = None,
    *,
    out: str | PathLike[str] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> ToleranceResult:
    """Draw cars within the production scatter of every parameter, solve each, and take their scatter apart.

    samples: number of cars, in place of the study's own; its seed and table [tolerance] decide the rest. out:
    folder for what `doe-kc tolerance --out` writes, its store among it, whose cars are not solved again; by
    default nothing is written (but an outside solver's answers always go to the study's store). workers:
    processes, one per core by default. scheduler: address of a Dask scheduler. progress: called with (what,
    cars done, of how many).

    Raises InputError for a table [tolerance] that cannot be, RunError when interrupted, when the unchanged
    axle has no equilibrium, or when more than half of the cars have none.

    >>> result = kc.tolerance("examples/front_axle", 60, workers=1)
    >>> result.to_frame().loc["vertical.bump_steer", "unit"], len(result.cars)
    ('deg/m', 60)
    >>> result.contributions("first_order")["static.toe"].idxmax()
    'static.toe'
    """
    chosen = as_study(study)
    if samples is not None and samples < FEWEST_CARS:
        raise InputError(f"tolerance: samples = {samples}, expected {FEWEST_CARS} or more cars.")
    count = samples or chosen.tolerance.samples
    with stored(chosen, out) as kept:
        done = study_tolerance(
            kept,
            samples=samples,
            workers=workers,
            scheduler=scheduler,
            progress=step_counter(progress, "tolerance", count + 1),
        )
    result = ToleranceResult(chosen, done)
    if out is not None:
        result.write(out, workers=workers)
    return result
