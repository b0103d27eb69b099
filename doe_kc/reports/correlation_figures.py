"""The pictures of a correlation, drawn side by side."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from doe_kc.correlation.result import Correlation
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.measurement import Measurement
from doe_kc.reports.axle_views import axle_figure, correlation_view
from doe_kc.reports.correlation_bars import parameter_figure
from doe_kc.reports.correlation_convergence import convergence_figure
from doe_kc.reports.correlation_curves import case_views, curve_figure
from doe_kc.reports.correlation_dna import dna_figure
from doe_kc.reports.hysteresis import hysteresis_figure
from doe_kc.reports.series import Job, draw_series


def write_correlation_figures(
    correlation: Correlation,
    measurement: Measurement | None,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
) -> list[Path]:
    """Pictures `correlation_dna`, `_parameters`, `_axle`, `_convergence`, one `curves_<load case>` each and,
    with records, `hysteresis`.

    Raises RunError when the folder cannot be written.
    """
    jobs: list[Job] = [
        (folder / "correlation_dna", partial(dna_figure, correlation, study)),
        (folder / "correlation_parameters", partial(parameter_figure, correlation, study)),
        (folder / "correlation_axle", partial(axle_figure, correlation_view(correlation, study))),
        (folder / "correlation_convergence", partial(convergence_figure, correlation, study)),
    ]
    views = case_views(correlation, measurement)
    jobs += [(folder / f"curves_{view.load_case}", partial(curve_figure, view, study)) for view in views]
    measured = [view for view in views if view.measured is not None]
    if measured:
        jobs.append((folder / "hysteresis", partial(hysteresis_figure, measured, study)))
    return draw_series(jobs, workers, pictures=pictures)
