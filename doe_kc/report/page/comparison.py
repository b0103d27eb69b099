"""The page of a comparison: model beside records, characteristic by characteristic and curve by curve."""

from __future__ import annotations

from pathlib import Path

from doe_kc.report.comparison_tables import compared_characteristic_table, compared_curve_table
from doe_kc.report.page.curves import curve_set_section
from doe_kc.report.page.glossary import glossary_section
from doe_kc.report.render.page import Section, table_html, write_page
from doe_kc.targets.comparison import Comparison

COMPARED_LEAD = "The model beside the measured car, and the interval in which a characteristic counts as met."


def comparison_sections(comparison: Comparison) -> list[Section]:
    """Characteristics, Curves, Deviation of every curve, Words."""
    return [
        Section("Characteristics", table_html(compared_characteristic_table(comparison)), COMPARED_LEAD),
        curve_set_section(comparison.measured, comparison.curve_sd, comparison.model),
        Section("Deviation of every curve", table_html(compared_curve_table(comparison))),
        glossary_section("noise", "± uncertainty", "interval"),
    ]


def write_comparison_page(path: Path, comparison: Comparison) -> Path:
    """Write the page; RunError when it cannot be written."""
    title = f"Comparison: {comparison.model.source} and {comparison.measured.source}"
    return write_page(path, title, comparison_sections(comparison))
