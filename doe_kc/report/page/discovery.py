"""The report page of a discovery: what the model lacks, how that was found, what to test next."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from doe_kc.discovery.result import Discovery
from doe_kc.measurement import Measurement
from doe_kc.report.discovery_library import library_table
from doe_kc.report.page.discovery_candidates import (
    candidates_section,
    held_out_section,
    scan_section,
    tests_section,
)
from doe_kc.report.page.discovery_curves import curves_section, gap_section
from doe_kc.report.page.discovery_maps import maps_section
from doe_kc.report.page.discovery_parameters import parameters_section
from doe_kc.report.page.discovery_verdict import verdict_section
from doe_kc.report.render.page import Section, table_html, write_page

LIBRARY_LEAD = (
    "Would have shown: it would have been found from the detectable size on, in four of five cars, if the "
    "model is right but for this; for a stiffness, a softer part would have been found. Not resolved: the "
    "same, but the model does not explain the records, so that nothing follows. Not testable: re-tuning "
    "absorbs it or it shows too little in these load cases; the parameters that hide it are named with the "
    "move that does so, and the parts that, measured on a bench, would show it, with the standard deviations "
    "that its typical size would then make."
)


def discovery_sections(
    discovery: Discovery, measurement: Measurement | None, *, notes: Mapping[str, str] | None = None
) -> list[Section]:
    """In the order of a test engineer's questions. notes: further lines of the first section."""
    made = {"Measurement": measurement.manifest.name} if measurement is not None else {}
    sections = [verdict_section(discovery, {**made, **(notes or {})}), maps_section(discovery)]
    sections += [
        candidates_section(discovery),
        *scan_section(discovery),
        *curves_section(discovery),
        gap_section(discovery),
    ]
    if discovery.held_out:
        sections.append(held_out_section(discovery))
    return [*sections, parameters_section(discovery), library_section(discovery), tests_section(discovery)]


def library_section(discovery: Discovery) -> Section:
    """One row a hypothesis, sortable and filterable."""
    return Section("Library of effects", table_html(library_table(discovery)), LIBRARY_LEAD)


def write_discovery_page(
    path: Path,
    discovery: Discovery,
    measurement: Measurement | None,
    *,
    study: str,
    date: str,
    notes: Mapping[str, str] | None = None,
) -> Path:
    """Write the page; RunError when it cannot be written."""
    sections = discovery_sections(discovery, measurement, notes=notes)
    return write_page(path, f"Missing effects: {study}", sections, subtitle=date)
