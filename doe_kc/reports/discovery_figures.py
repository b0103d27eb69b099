"""The pictures of a discovery, drawn side by side."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from doe_kc.discovery.result import Discovery
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.reports.discovery_curves import curve_figure, worst_views
from doe_kc.reports.discovery_evidence import evidence_figure, evidence_steps
from doe_kc.reports.discovery_gaps import gap_figure
from doe_kc.reports.discovery_heat_map import discovery_grids, heat_map_figure
from doe_kc.reports.discovery_held_out import held_out_figure
from doe_kc.reports.discovery_isolability import isolability
from doe_kc.reports.discovery_isolability_figure import isolability_figure
from doe_kc.reports.discovery_parameter_figure import parameter_figure
from doe_kc.reports.discovery_parameters import tuned_parameters
from doe_kc.reports.discovery_tables import gap_rows
from doe_kc.reports.series import Job, draw_series


def discovery_jobs(discovery: Discovery, folder: Path, study: str) -> list[Job]:
    """What is drawn: (path without suffix, maker). Makers hold only the numbers that they draw."""
    jobs: list[Job] = [
        (folder / "disagreement", partial(heat_map_figure, discovery_grids(discovery), study)),
        (folder / "gap", partial(gap_figure, gap_rows(discovery), study)),
        (folder / "evidence", partial(evidence_figure, evidence_steps(discovery), study)),
        (folder / "worst_curves", partial(curve_figure, worst_views(discovery), study)),
        (folder / "isolability", partial(isolability_figure, isolability(discovery), study)),
        (folder / "parameters", partial(parameter_figure, tuned_parameters(discovery), study)),
    ]
    if discovery.held_out:
        jobs.append((folder / "held_out", partial(held_out_figure, discovery.held_out, study)))
    return jobs


def write_discovery_figures(
    discovery: Discovery,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
) -> list[Path]:
    """Pictures `disagreement`, `gap`, `evidence`, `worst_curves`, `isolability`, `parameters` and, where
    effects were found, `held_out`. RunError when the folder cannot be written."""
    return draw_series(discovery_jobs(discovery, folder, study), workers, pictures=pictures)
