"""The page of reduced rig records: the targets with their errors, and every curve."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.ground.numbers import with_sd
from doe_kc.measurement import Measurement
from doe_kc.report.names import case_label
from doe_kc.report.page.curves import curve_set_section
from doe_kc.report.page.glossary import glossary_section
from doe_kc.report.render.page import Section, table_html, write_page
from doe_kc.report.table import Column, PageCell, PageLayout, Table


@dataclass(frozen=True)
class MeasuredCharacteristic:
    """value, sd: in `entry.unit`."""

    entry: Characteristic
    value: float
    sd: float


MEASURED_COLUMNS: tuple[Column[MeasuredCharacteristic], ...] = (
    Column("label", "Characteristic", lambda m: m.entry.label,
           page=PageCell(style="first", attributes=lambda m: {"title": m.entry.id})),
    Column("load_case", "Load case", lambda m: case_label(m.entry.load_case), page=PageCell()),
    Column("unit", "Unit", lambda m: m.entry.unit, page=PageCell()),
    Column("value", "Measured ± sd", lambda m: m.value, "0.0000",
           page=PageCell(text=lambda m: with_sd(m.value, m.sd), strong=lambda m: True)),
    Column("id", "Id", lambda m: m.entry.id, page=PageCell()),
)  # fmt: skip
MEASURED_LEAD = "Figures read off the measured curves of the left wheel: the targets of a correlation."


def _measured(measurement: Measurement) -> Iterator[MeasuredCharacteristic]:
    for name, estimate in measurement.characteristics.items():
        if math.isfinite(estimate.value):
            yield MeasuredCharacteristic(CHARACTERISTICS[name], estimate.value, estimate.sd)


def measurement_sections(measurement: Measurement) -> list[Section]:
    """Characteristics, Curves, Words."""
    layout = PageLayout[MeasuredCharacteristic]("measured-table", "Characteristics", filtered=True)
    table = Table("Measured", MEASURED_LEAD, MEASURED_COLUMNS, list(_measured(measurement)), page=layout)
    sd = {case: measurement.curve_sd(case) for case in measurement.curves.cases}
    return [
        Section("Characteristics", table_html(table), MEASURED_LEAD),
        curve_set_section(measurement.curves, sd, None),
        glossary_section("noise", "± uncertainty"),
    ]


def write_measurement_page(path: Path, measurement: Measurement) -> Path:
    """Write the page; RunError when it cannot be written."""
    return write_page(path, f"Rig records: {measurement.manifest.name}", measurement_sections(measurement))
