"""The page of reduced rig records: the targets with their errors, and every curve."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from doe_kc.measurement import Measurement
from doe_kc.reports.characteristic_columns import by_load_case
from doe_kc.reports.measurement.tables import measured_characteristic_table
from doe_kc.reports.page.cars import cars_section
from doe_kc.reports.page.curves import curve_set_section
from doe_kc.reports.page.glossary import glossary_section
from doe_kc.reports.render.page import Section, table_html, write_page
from doe_kc.targets.comparison import CarComparison

MEASURED_LEAD = "Figures read off the measured curves of the left wheel: the targets of a correlation."


def measurement_sections(measurement: Measurement, cars: Sequence[CarComparison] = ()) -> list[Section]:
    """Characteristics, Cars where there are several, Curves, Words."""
    table = measured_characteristic_table(measurement)
    rows = [r for r in table.rows if math.isfinite(r.estimate.value)]
    known = replace(table, rows=by_load_case(rows, lambda r: r.entry.load_case))
    sd = {case: measurement.curve_sd(case) for case in measurement.curves.cases}
    return [
        Section("Characteristics", table_html(known), MEASURED_LEAD),
        *cars_section(cars),
        curve_set_section(measurement.curves, sd, None),
        glossary_section("noise", "± uncertainty"),
    ]


def write_measurement_page(path: Path, measurement: Measurement, cars: Sequence[CarComparison] = ()) -> Path:
    """Write the page; RunError when it cannot be written."""
    title = f"Rig records: {measurement.manifest.name}"
    return write_page(path, title, measurement_sections(measurement, cars))
