"""Comparison: an axle against the rig records of a study."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.api.axle import as_axle
from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import as_study
from doe_kc.axle import Axle
from doe_kc.reports.comparison.tables import compared_characteristic_table, compared_curve_table
from doe_kc.reports.render.csv import table_frame
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.study import Study
from doe_kc.targets.comparison import Comparison
from doe_kc.workflow.compare import compare_model, write_comparison
from doe_kc.workflow.measure import study_measurement

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class ComparisonResult(FrameResult):
    """Model and measurement. comparison: both curve sets, characteristics and RMS deviations."""

    study: Study
    comparison: Comparison

    @property
    def characteristics(self) -> pd.DataFrame:
        """One row a characteristic that was measured, its id as index: label, load_case, unit, model, target,
        target_sd, difference (model minus target), low, high (constraint interval), inside."""
        return table_frame(compared_characteristic_table(self.comparison)).set_index("name")

    @property
    def curves(self) -> pd.DataFrame:
        """One row a curve: load_case, response, unit, side, rms and rms_half_width (deviation), span."""
        return table_frame(compared_curve_table(self.comparison))

    def to_frame(self) -> pd.DataFrame:
        """`characteristics`."""
        return self.characteristics

    @property
    def lines(self) -> list[str]:
        """Names, and how many characteristics lie inside."""
        rows = self.comparison.characteristics
        inside = sum(r.inside for r in rows)
        names = f"{self.comparison.model.source} against {self.comparison.measured.source}"
        return [names, f"{inside} of {len(rows)} characteristics inside their constraint interval"]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Difference of every characteristic in half widths of its constraint interval: within +-1 is met."""
        from doe_kc.api.deviation_plot import draw_deviations
        from doe_kc.reports.drawing.style import PALETTE

        rows = self.comparison.characteristics
        half = np.array([(r.high - r.low) / 2.0 for r in rows])
        places = np.array([r.difference for r in rows]) / half
        labels = [r.entry.id for r in rows]
        return draw_deviations(labels, {"model": (places, PALETTE["blue"])}, ax)

    def plot_curves(self, load_case: str, response: str = "toe", ax: Axes | None = None) -> Axes:
        """Curves of model and measurement; response as in `SimulationResult.plot`."""
        from doe_kc.api.axes import axes_or_new, check_curve, draw_curves

        both = self.comparison
        check_curve(both.measured, load_case, response)
        check_curve(both.model, load_case, response)
        ax = axes_or_new(ax, (6.4, 4.4))
        draw_curves(ax, both.measured, load_case, response, measured=True)
        draw_curves(ax, both.model, load_case, response)
        return ax

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """characteristics.csv, curves.csv and a picture a load case in `out`/compare; returns the paths."""
        pictures = self.study.pictures
        return write_comparison(self.comparison, Path(out) / "compare", workers=workers, pictures=pictures)


def compare(
    study: Study | str | PathLike[str], axle: Axle | str | PathLike[str] | None = None
) -> ComparisonResult:
    """An axle, by default the study's, against the study's rig records: characteristics with their constraint
    intervals (+-15 % about), curves with RMS deviations. Nothing is written.

    Raises InputError for a record that is wrong or a study without measurement, RunError where the axle has
    no equilibrium.

    >>> result = kc.compare("examples/front_axle")
    >>> result.characteristics.loc["static.toe", "unit"]
    'deg'
    """
    chosen = as_study(study)
    measurement = study_measurement(chosen)
    model = curve_set(solve(chosen.axle if axle is None else chosen.as_measured(as_axle(axle))))
    return ComparisonResult(chosen, compare_model(chosen, model, measurement))
