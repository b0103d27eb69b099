"""Discovery: what the axle lacks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import Progress, as_study, stored
from doe_kc.axle import Axle
from doe_kc.discovery.result import Discovery, Gap, VerdictKind
from doe_kc.measurement import Measurement
from doe_kc.reports.discovery.effects import effect_table
from doe_kc.reports.discovery.library import library_table
from doe_kc.reports.discovery.parameters import tuned_table
from doe_kc.reports.discovery.tables import gap_table, held_out_table
from doe_kc.reports.discovery.words import MODEL_LABELS
from doe_kc.reports.render.csv import table_frame
from doe_kc.study import Study
from doe_kc.workflow.discover import discover_study
from doe_kc.workflow.discovery_document import discovery_lines
from doe_kc.workflow.measure import study_measurement
from doe_kc.workflow.twin_discovery import discovery_ground
from doe_kc.workflow.write_discovery import write_discovery

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

LINE_LENGTH, LINES = 160, 6
"""Of the `repr`."""


@dataclass(frozen=True, repr=False, eq=False)
class DiscoveryResult(FrameResult):
    """A finished discovery. discovery: verdict and all that stands behind it; measurement: the records."""

    study: Study
    discovery: Discovery
    measurement: Measurement

    @property
    def verdict(self) -> VerdictKind:
        """named, class (one of several), none (none needed) or unexplained."""
        return self.discovery.verdict

    @property
    def sentences(self) -> tuple[str, ...]:
        """The verdict in words."""
        return self.discovery.sentences

    @property
    def axle(self) -> Axle:
        """The study's axle refitted to the records, with the effects; not yet correlated to the targets."""
        fitted = self.discovery.fitted
        return fitted.model.axle_at(fitted.z)

    @property
    def gap(self) -> Gap:
        """Whitened RMS of the deviations from the records, 1 is noise: nominal, tuned, with_effect."""
        return self.discovery.gap

    @property
    def effects(self) -> pd.DataFrame:
        """One row a number of an effect: effect, place, kind, probability, size, value, sd, unit, ...; empty
        where none is needed."""
        return table_frame(effect_table(self.discovery))

    @property
    def library(self) -> pd.DataFrame:
        """One row a hypothesis that was looked at, and what became of it."""
        return table_frame(library_table(self.discovery))

    @property
    def gaps(self) -> pd.DataFrame:
        """The gap of every response in every load case."""
        return table_frame(gap_table(self.discovery))

    @property
    def held_out(self) -> pd.DataFrame:
        """One row a load case that was predicted from the others."""
        return table_frame(held_out_table(self.discovery))

    @property
    def parameters(self) -> pd.DataFrame:
        """One row a tunable parameter: nominal, without and with the effects."""
        return table_frame(tuned_table(self.discovery))

    def to_frame(self) -> pd.DataFrame:
        """`effects`."""
        return self.effects

    @property
    def lines(self) -> list[str]:
        """Verdict, effects, gap."""
        lines = discovery_lines(self.discovery)[:LINES]
        return [line if len(line) <= LINE_LENGTH else f"{line[: LINE_LENGTH - 3]}..." for line in lines]

    def plot(self, ax: Axes | None = None) -> Axes:
        """The gap of every curve, as handed in, re-tuned, and with the effects; 1 is noise."""
        from doe_kc.api.axes import axes_or_new
        from doe_kc.curves import response_name
        from doe_kc.reports.drawing.style import PALETTE

        rows = self.discovery.gaps
        ax = axes_or_new(ax, (6.4, 1.6 + 0.19 * len(rows)))
        places = np.arange(len(rows))
        colours = {"nominal": "orange", "tuned": "grey"}
        if self.discovery.fitted.model.members:
            colours["with_effect"] = "blue"
        for model, colour in colours.items():
            values = [getattr(r.gap, model) for r in rows]
            ax.plot(values, places, "o", ms=4, color=PALETTE[colour], label=MODEL_LABELS[model])
        ax.axvline(self.gap.noise_floor, color="black", lw=0.8, ls="--", label="noise")
        ax.set_xscale("log")
        ax.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        ax.set_yticks(places, [f"{r.load_case} {response_name(r.response)}" for r in rows], fontsize="small")
        ax.set_ylim(len(rows) - 0.5, -0.5)
        ax.grid(axis="y", color="#DDDDDD", lw=0.5)
        ax.set_xlabel("deviation from the records, times its noise [-]")
        ax.legend(fontsize="small", loc="lower right")
        return ax

    def write(self, out: str | PathLike[str], *, workers: int | None = None) -> list[Path]:
        """What `doe-kc discover` writes, in `out`/discover: axle files, tables, workbook, page, pictures;
        returns the paths."""
        folder = Path(out) / "discover"
        return write_discovery(self.study, self.discovery, self.measurement, folder, workers=workers)


def discover(
    study: Study | str | PathLike[str],
    *,
    exclude: Sequence[str] = (),
    out: str | PathLike[str] | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> DiscoveryResult:
    """Find where model and records disagree, and name the missing effect with its size, or say that none is
    needed, or that the records show something that no effect of the library explains.

    exclude: ids of effects not to look for, see docs/effects.md. out: folder for what `doe-kc discover --out`
    writes, and of a store from which the same call goes on after an interruption; by default nothing is
    written. workers: processes, one per core by default. progress: called with (what, steps done, of how many
    about).

    Raises InputError for a study or record that is wrong, an unknown effect, or an outside solver
    without a twin or curves (through its twin the answer is the outside model's); RunError where the axle
    has no equilibrium.

    >>> result = kc.discover("examples/front_axle", workers=1)
    >>> result.verdict
    'named'
    >>> list(result.effects["effect"].unique())
    ['hub_compliance']
    """
    chosen = as_study(study)
    measurement = study_measurement(chosen)
    with stored(chosen, out) as kept:
        ground = discovery_ground(kept, measurement)
        result = discovery_of(
            ground.study, ground.records, exclude=exclude, workers=workers, progress=progress
        )
    if out is not None:
        result.write(out, workers=workers)
    return replace(result, study=replace(ground.study, out=chosen.out))


def discovery_of(
    study: Study,
    measurement: Measurement,
    *,
    exclude: Sequence[str] = (),
    workers: int | None = None,
    progress: Progress | None = None,
) -> DiscoveryResult:
    """The same of records that are reduced already."""
    watch = progress or (lambda *_: None)
    discovery = discover_study(study, measurement, exclude=exclude, workers=workers, progress=watch)
    return DiscoveryResult(study, discovery, measurement)
