"""The page of a simulated axle: its characteristics and every curve."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import CurveSet
from doe_kc.reports.characteristic_columns import by_load_case
from doe_kc.reports.page.curves import curve_set_section
from doe_kc.reports.render.page import Section, table_html, write_page
from doe_kc.reports.simulation.tables import SimulatedCharacteristic, simulated_table

SIMULATED_LEAD = "Figures read off the curves of the left wheel."


def simulation_sections(curves: CurveSet, values: Mapping[str, float]) -> list[Section]:
    """Characteristics, Curves. values: of the characteristics by id; those that are not finite are absent."""
    rows = [
        SimulatedCharacteristic(CHARACTERISTICS[name], value)
        for name, value in values.items()
        if math.isfinite(value)
    ]
    ordered = by_load_case(rows, lambda r: r.entry.load_case)
    return [
        Section("Characteristics", table_html(simulated_table(ordered)), SIMULATED_LEAD),
        curve_set_section(None, {}, curves, "axle as handed in"),
    ]


def write_simulation_page(
    path: Path, curves: CurveSet, values: Mapping[str, float], *, study: str, date: str
) -> Path:
    """Write the page; RunError when it cannot be written."""
    sections = simulation_sections(curves, values)
    return write_page(path, f"The axle as handed in: {study}", sections, subtitle=date)
