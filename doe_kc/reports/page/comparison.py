"""The page of a comparison: model beside records, characteristic by characteristic and curve by curve."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from doe_kc.reports.characteristic_columns import by_load_case
from doe_kc.reports.comparison.tables import compared_characteristic_table, compared_curve_table
from doe_kc.reports.page.cars import cars_section
from doe_kc.reports.page.curves import curve_set_section
from doe_kc.reports.page.glossary import glossary_section
from doe_kc.reports.render.page import Section, table_html, write_page
from doe_kc.targets.comparison import Comparison

COMPARED_LEAD = "The model beside the measured car, and the interval in which a characteristic counts as met."


def comparison_sections(comparison: Comparison) -> list[Section]:
    """Characteristics, Cars where there are several, Curves, Deviation of every curve, Words."""
    table = compared_characteristic_table(comparison)
    table = replace(table, rows=by_load_case(table.rows, lambda c: c.entry.load_case))
    return [
        Section("Characteristics", table_html(table), COMPARED_LEAD),
        *cars_section(comparison.cars),
        curve_set_section(comparison.measured, comparison.curve_sd, comparison.model),
        Section("Deviation of every curve", table_html(compared_curve_table(comparison))),
        glossary_section("noise", "± uncertainty", "interval"),
    ]


def write_comparison_page(path: Path, comparison: Comparison) -> Path:
    """Write the page; RunError when it cannot be written."""
    title = f"Comparison: {comparison.model.source} and {comparison.measured.source}"
    return write_page(path, title, comparison_sections(comparison))
