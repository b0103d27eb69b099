"""Compare: the model's curves and characteristics beside the measured ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from doe_kc.characteristics import reduce_all
from doe_kc.curves import CurveSet
from doe_kc.ground.output import write_columns
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.measurement import Measurement
from doe_kc.reports.comparison.car_table import cars_entry, write_cars
from doe_kc.reports.comparison.tables import compared_characteristic_table, compared_curve_table
from doe_kc.reports.render.csv import table_columns
from doe_kc.reports.render.json import table_records
from doe_kc.reports.render.terminal import table_lines
from doe_kc.study import Study
from doe_kc.targets.comparison import Comparison, compare, compare_cars


def compare_model(study: Study, model: CurveSet, measurement: Measurement) -> Comparison:
    """Model against measurement in the study's fit windows."""
    spread = {name: estimate.sd for name, estimate in measurement.characteristics.items()}
    noise = {case: measurement.curve_sd(case) for case in measurement.curves.cases}
    compared = compare(model, measurement.curves, target_sd=spread, windows=study.windows, curve_sd=noise)
    return replace(compared, cars=compare_cars(measurement, reduce_all(model, study.windows)))


def write_comparison(
    comparison: Comparison, folder: Path, *, workers: int | None = None, pictures: PictureFormat = PNG
) -> list[Path]:
    """characteristics.csv, curves.csv (RMS), report.html and one figure a load case."""
    from doe_kc.reports.page.comparison import write_comparison_page
    from doe_kc.reports.page.links import link_pages

    written = [
        write_columns(
            folder / "characteristics.csv", table_columns(compared_characteristic_table(comparison))
        ),
        write_columns(folder / "curves.csv", table_columns(compared_curve_table(comparison))),
        write_comparison_page(folder / "report.html", comparison),
        *write_cars(comparison.cars, folder),
    ]
    link_pages(folder.parent)
    if pictures == "none":
        return written
    from doe_kc.reports.comparison.figures import write_comparison_figures

    return written + write_comparison_figures(comparison, folder, workers=workers, pictures=pictures)


def comparison_lines(comparison: Comparison) -> list[str]:
    """The table for a terminal; * marks what lies outside its constraint interval."""
    lines = table_lines(compared_characteristic_table(comparison))
    outside = sum(not row.inside for row in comparison.characteristics)
    lines.append(f"{outside} of {len(comparison.characteristics)} outside their constraint interval (*)")
    return lines


def comparison_document(comparison: Comparison) -> dict[str, Any]:
    """Characteristics and RMS deviations as records."""
    return {
        "characteristics": table_records(compared_characteristic_table(comparison)),
        "curves": table_records(compared_curve_table(comparison)),
        **cars_entry(comparison.cars),
    }
