"""Measurement: the rig records of a study, reduced."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import as_study
from doe_kc.reports.measurement.tables import (
    gradient_table,
    measured_characteristic_table,
    measured_curve_frame,
    noise_table,
)
from doe_kc.reports.render.csv import table_frame
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from doe_kc.study import Study
from doe_kc.workflow.compare import compare_model, write_comparison
from doe_kc.workflow.measure import Reduced, reduce_records, write_reduced

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class ReductionResult(FrameResult):
    """Reduced rig records. reduced: measurement and ride height; solution: of the study's axle, which the
    ride height is relative to."""

    study: Study
    reduced: Reduced
    solution: Solution

    @cached_property
    def characteristics(self) -> pd.DataFrame:
        """One row a characteristic, its id as index: load_case, response, unit, value, sd (standard error);
        nan where the records do not show it."""
        return table_frame(measured_characteristic_table(self.reduced.measurement)).set_index("name")

    @cached_property
    def curves(self) -> pd.DataFrame:
        """One row a point: load_case, input, input_unit, side, response, unit, mean, half_width, sd.

        mean: of both branches, change from static but for the tyre load; half_width: half the hysteresis.
        """
        return measured_curve_frame(self.reduced.measurement)

    @property
    def gradients(self) -> pd.DataFrame:
        """One row a curve: load_case, response, side, unit, value, sd, window, input_unit."""
        return table_frame(gradient_table(self.reduced.measurement))

    @property
    def noise(self) -> pd.DataFrame:
        """One row a curve: standard deviations of its error's components."""
        return table_frame(noise_table(self.reduced.measurement))

    @property
    def ride_height(self) -> tuple[float, float] | None:
        """Ride height of the car minus the model's and its standard error, mm, + = body lower; None without a
        record `vertical`."""
        height = self.reduced.ride_height
        return None if height is None else (height.estimate, height.sd)

    def to_frame(self) -> pd.DataFrame:
        """`characteristics`."""
        return self.characteristics

    @property
    def lines(self) -> list[str]:
        """Car, load cases, ride height."""
        measurement = self.reduced.measurement
        known = int(self.characteristics["value"].notna().sum())
        lines = [
            f"{measurement.manifest.name}, {known} characteristics",
            f"load cases: {', '.join(measurement.curves.cases)}",
        ]
        if self.ride_height is not None:
            lines.append("ride height {:+.2f} +- {:.2f} mm (+ = body lower)".format(*self.ride_height))
        return lines

    def plot(self, load_case: str | None = None, response: str = "toe", ax: Axes | None = None) -> Axes:
        """Measured curves of both wheels, a band between the branches; load_case: by default the first.

        response: toe, camber, spin (deg), wc_x, wc_y, wc_z (mm), changes from static; tyre_load (N).
        InputError for one that was not measured.
        """
        from doe_kc.api.axes import axes_or_new, check_curve, draw_curves

        curves = self.reduced.measurement.curves
        case = load_case or next(iter(curves.cases))
        check_curve(curves, case, response)
        ax = axes_or_new(ax, (6.4, 4.4))
        draw_curves(ax, curves, case, response, measured=True)
        return ax

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc reduce` writes, in `out`/reduce and `out`/compare; returns the paths."""
        folder, pictures = Path(out), self.study.pictures
        measurement = self.reduced.measurement
        comparison = compare_model(self.study, curve_set(self.solution), measurement)
        return [
            *write_reduced(self.reduced, folder / "reduce", workers=workers, pictures=pictures),
            *write_comparison(comparison, folder / "compare", workers=workers, pictures=pictures),
        ]


def reduce(study: Study | str | PathLike[str]) -> ReductionResult:
    """Reduce the rig records of a study: mean and half-width curves, noise, gradients, characteristics and
    the ride height that no record states.

    study: a `Study`, its file or its folder. Nothing is written.

    Raises InputError naming file and row for a record that is wrong, or a study without measurement; RunError
    where its axle has no equilibrium.

    >>> result = kc.reduce("examples/front_axle")
    >>> result.characteristics.loc["lateral.toe_change", "unit"]
    'deg/kN'
    """
    chosen = as_study(study)
    chosen.measured()
    solution = solve(chosen.axle)
    return ReductionResult(chosen, reduce_records(chosen, solution), solution)
