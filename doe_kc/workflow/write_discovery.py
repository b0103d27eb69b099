"""Handover of a discovery: everything that it leaves to the engineer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from datetime import date
from pathlib import Path
from typing import Any

from doe_kc.axle_file.write import write_axle
from doe_kc.discovery.result import Discovery
from doe_kc.effects.words import hypothesis_words
from doe_kc.ground.output import write_columns
from doe_kc.measurement import Measurement
from doe_kc.reports.discovery.effects import effect_table
from doe_kc.reports.discovery.figures import discovery_figures
from doe_kc.reports.discovery.isolability import isolability_table
from doe_kc.reports.discovery.library import library_table
from doe_kc.reports.discovery.parameters import tuned_table
from doe_kc.reports.discovery.tables import disagreement_table, gap_table, held_out_table
from doe_kc.reports.discovery.words import headline
from doe_kc.reports.discovery.workbook import write_discovery_workbook
from doe_kc.reports.page.discovery import write_discovery_page
from doe_kc.reports.page.links import link_pages
from doe_kc.reports.render.csv import table_columns
from doe_kc.reports.table import Table
from doe_kc.study import Study
from doe_kc.workflow.write_correlation import AXLE

DISCOVERY_TABLES: Mapping[str, Callable[[Discovery], Table[Any]]] = {
    "disagreement.csv": disagreement_table,
    "effects.csv": effect_table,
    "library.csv": library_table,
    "groups.csv": isolability_table,
    "gap.csv": gap_table,
    "held_out.csv": held_out_table,
    "parameters.csv": tuned_table,
}
EFFECTS_ONLY = "axle_effects_only.toml"


def write_discovery(
    study: Study,
    discovery: Discovery,
    measurement: Measurement,
    folder: Path,
    *,
    workers: int | None = None,
) -> list[Path]:
    """axle.toml (refitted, with the effects), seven tables, discovery.xlsx, report.html and the figures.

    Where there are effects, axle_effects_only.toml is the study's axle with them, and with friction the
    loops driven before the record; nothing else changed.
    Returns the paths. workers: processes that draw. RunError when the folder cannot be written.
    """
    axle = discovery.fitted.model.axle_at(discovery.fitted.z)
    written = [write_axle(study.as_designed(axle), study.axle_path, folder / AXLE, note=axle_note(discovery))]
    if discovery.fitted.model.members:
        extended = discovery.fitted.model.with_effects(discovery.fitted.z)
        extended = study.as_designed(extended)
        written.append(write_axle(extended, study.axle_path, folder / EFFECTS_ONLY, note="effects only"))
    notes = {
        "Axle": f"{axle.name}: {AXLE}, from {study.axle_path.name}",
        "Run time": f"{discovery.seconds:.0f} s",
    }
    words: dict[str, Any] = {"study": study.name, "date": date.today().isoformat()}
    known = {"Measurement": measurement.manifest.name, **notes}
    figures = discovery_figures(discovery, folder, study=study.name, workers=workers, pictures=study.pictures)
    with figures as pictures:
        page = write_discovery_page(folder / "report.html", discovery, measurement, notes=notes, **words)
        link_pages(folder.parent)
        tables = [
            write_columns(folder / name, table_columns(of(discovery)))
            for name, of in DISCOVERY_TABLES.items()
        ]
        workbook = write_discovery_workbook(folder / "discovery.xlsx", discovery, notes=known, **words)
    return [*written, *tables, workbook, page, *pictures]


def axle_note(discovery: Discovery) -> str:
    """First line of the axle file: the verdict, and what the file holds beyond the nominal axle."""
    members = ", ".join(hypothesis_words(h) for h in discovery.fitted.model.members)
    unsure = [f for f in discovery.findings if f.verdict == "lead"]
    lead = "leads, not confirmed: " if unsure and len(unsure) == len(discovery.findings) else ""
    return f"{headline(discovery).lower()}; re-tuned" + (f" with {lead}{members}" if members else "")
