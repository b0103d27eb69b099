"""The pictures of a discovery, drawn side by side."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from functools import partial
from pathlib import Path

from matplotlib.lines import Line2D

from doe_kc.discovery.result import Discovery
from doe_kc.discovery.verdict.held_out import HeldOut
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.load_cases import case_label
from doe_kc.reports.discovery.curves import curve_figure, worst_views
from doe_kc.reports.discovery.evidence import evidence_figure, evidence_steps
from doe_kc.reports.discovery.gaps import MODEL_COLOURS, gap_figure
from doe_kc.reports.discovery.heat_map import discovery_grids, heat_map_figure
from doe_kc.reports.discovery.isolability import isolability
from doe_kc.reports.discovery.isolability_figure import isolability_figure
from doe_kc.reports.discovery.parameter_figure import parameter_figure
from doe_kc.reports.discovery.parameters import tuned_parameters
from doe_kc.reports.discovery.tables import gain_words, gap_rows
from doe_kc.reports.discovery.words import MODEL_LABELS
from doe_kc.reports.drawing.panel import Panel
from doe_kc.reports.drawing.series import Job, series_beside
from doe_kc.reports.drawing.sheet import Sheet, sheet

HELD_OUT_ROW = 0.3
HELD_OUT_TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500)


def held_out_figure(cases: Sequence[HeldOut], study: str) -> Sheet:
    """A row a load case: predicted RMS of the re-tuned model and of the one with the effect, log axis."""
    height = HELD_OUT_ROW * max(len(cases), 2) + 1.45
    margins = {"left": 0.23, "right": 0.83, "top": 1 - 0.65 / height, "bottom": 0.8 / height}
    page, panels = sheet(1, 1, size=(8.27, height), margins=margins)
    panel = panels[0, 0]
    panel.x.set_logarithmic()
    highest = 1.4 * max([3.0, *(max(h.tuned.rms, h.with_effect.rms) for h in cases)])
    panel.x.set_limits(min([0.75, *(0.9 * h.with_effect.rms for h in cases)]), highest)
    ticks = [t for t in HELD_OUT_TICKS if t <= highest]
    panel.x.set_ticks(ticks, [str(t) for t in ticks])
    panel.y.set_limits(max(len(cases), 1), 0)
    panel.grid["y"] = panel.marks["y"] = False
    panel.y.set_ticks([i + 0.5 for i in range(len(cases))], [case_label(h.load_case) for h in cases])
    panel.vline(1.0, (0, (4, 2)), color="black", lw=0.9, zorder=1)
    for y, held in enumerate(cases):
        _row(panel, y + 0.5, held)
    panel.text(1.02, -0.15, "gain, ln density", scales=("panel", "data"), size=6.5, color="#555555")
    panel.set_labels("RMS of the held-out records, in standard deviations of their prediction", None)
    page.add_legend(_handles(), 3)
    page.set_heading(f"Load cases held out: {study}", 1 - 0.12 / height)
    return page


def _row(panel: Panel, y: float, held: HeldOut) -> None:
    one, two = held.tuned.rms, held.with_effect.rms
    panel.plot([one, two], [y, y], color="#C9CED3", lw=1.2)
    panel.plot(one, y, "", marker="o", color=MODEL_COLOURS["tuned"], mfc="white", ms=5, mew=1.3)
    panel.plot(two, y, "", marker="D", color=MODEL_COLOURS["with_effect"], ms=4.5)
    panel.text(1.02, y, gain_words(held.gain), scales=("panel", "data"), size=7.0, along="center")


def _handles() -> list[Line2D]:
    return [
        Line2D([], [], color=MODEL_COLOURS["tuned"], ls="", marker="o", mfc="white", mew=1.3,
               label=MODEL_LABELS["tuned"]),
        Line2D([], [], color=MODEL_COLOURS["with_effect"], ls="", marker="D", ms=4.5,
               label=MODEL_LABELS["with_effect"]),
        Line2D([], [], color="black", ls="--", lw=0.9, label="as good as predicted"),
    ]  # fmt: skip


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


def discovery_figures(
    discovery: Discovery,
    folder: Path,
    *,
    study: str,
    workers: int | None = None,
    pictures: PictureFormat = PNG,
) -> AbstractContextManager[list[Path]]:
    """Draws, beside what is done meanwhile, the pictures `disagreement`, `gap`, `evidence`, `worst_curves`,
    `isolability`, `parameters` and, where effects were found, `held_out`. RunError when the folder cannot be
    written."""
    return series_beside(discovery_jobs(discovery, folder, study), workers, pictures=pictures)
