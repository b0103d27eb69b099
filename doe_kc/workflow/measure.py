"""Reduce: rig records to curves, noise, gradients, targets, ride height and pictures."""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.axle import Axle, design_parameters
from doe_kc.characteristics import reduce_all
from doe_kc.curves import RIG_RESPONSES, TYRE_LOAD, CurveSet
from doe_kc.ground.output import write_columns
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Measurement, RideHeight, infer_ride_height, reduce_cars
from doe_kc.reports.comparison.car_table import cars_entry, write_cars
from doe_kc.reports.measurement.tables import (
    gradient_table,
    measured_characteristic_table,
    measured_curve_columns,
    noise_table,
)
from doe_kc.reports.render.csv import table_columns
from doe_kc.reports.render.json import table_records
from doe_kc.solver.curve_set import curve_set, mean_and_half_width, rising
from doe_kc.solver.result import Solution
from doe_kc.solver.sensitivity import sensitivities
from doe_kc.solver.suite import solve
from doe_kc.study import Study
from doe_kc.targets.comparison import CarComparison, compare_cars
from doe_kc.workflow.rig_checks import axle_curves, refuse_faulty, rig_findings
from doe_kc.workflow.setup import setup_differences


def vertical_scatter(axle: Axle, solution: Solution) -> dict[str, FloatArray]:
    """Response -> (n, p) one-sigma changes of the left `vertical` curves on their rising input grid.

    Angles and wheel centre as change from static; columns: scattering parameters. From the exact
    sensitivities.
    """
    scattering = [p for p in design_parameters(axle) if p.production_sd > 0]
    case = solution.cases["vertical"]
    alone = replace(solution, cases={"vertical": case})
    exact = sensitivities(axle, alone, [p.path for p in scattering])
    mean, _ = mean_and_half_width(case, list(exact.branches["vertical"]))
    sigma = np.array([p.production_sd for p in scattering])
    zero = int(np.argmin(np.abs(rising(case))))
    out = {}
    for response in RIG_RESPONSES:
        curve = mean[:, solution.column(f"{response}@L")] * sigma
        out[response] = curve if response == TYRE_LOAD else curve - curve[zero]
    return out


log = logging.getLogger("doe_kc")


@dataclass(frozen=True)
class Reduced:
    """ride_height: difference to the study's axle; None without a `vertical` record. cars: that axle beside
    the single cars, where several were measured."""

    measurement: Measurement
    ride_height: RideHeight | None
    cars: tuple[CarComparison, ...] = ()


def study_records(study: Study) -> Reduced | None:
    """The study's reduced records; None when it names no measurement."""
    return reduce_records(study, solve(study.axle)) if study.measurement is not None else None


def study_measurement(study: Study, model: CurveSet | None = None) -> Measurement:
    """The study's reduced records, of several cars their mean.

    InputError when it names none, or where physics says that they are wrong.

    Warns where the set-up differs and of what looks wrong. model: curves of the study's axle, solved if None.
    """
    paths = study.measured()
    measurement = reduce_cars(paths, windows=study.windows, half_track=study.axle.half_track)
    model = axle_curves(study.axle) if model is None else model
    for path, car in zip(paths, measurement.cars or (measurement,), strict=True):
        for sentence in setup_differences(study.axle, car.manifest):
            log.warning(sentence)
        source = path / "test.toml" if path.is_dir() else path
        refuse_faulty(rig_findings(source, car.manifest, car.runs, model))
    return measurement


def reduce_records(study: Study, solution: Solution) -> Reduced:
    """The study's records, and their ride height relative to the solved model."""
    model = curve_set(solution)
    measurement = study_measurement(study, model)
    height = None
    vertical = measurement.curves.cases.get("vertical")
    if vertical is not None and {"wc_z", "tyre_load"} <= set(vertical.mean) and "vertical" in solution.cases:
        height = infer_ride_height(
            measurement.curves,
            model,
            measurement.noise["vertical"],
            scatter=vertical_scatter(study.axle, solution),
        )
    return Reduced(measurement, height, compare_cars(measurement, reduce_all(model, study.windows)))


def write_reduced(
    reduced: Reduced, folder: Path, *, workers: int | None = None, pictures: PictureFormat = PNG
) -> list[Path]:
    """curves.csv, characteristics.csv, gradients.csv, noise.csv, cars.csv of several cars, report.html and
    one picture a load case."""
    measurement = reduced.measurement
    tables = {
        "curves.csv": measured_curve_columns(measurement),
        "characteristics.csv": table_columns(measured_characteristic_table(measurement)),
        "gradients.csv": table_columns(gradient_table(measurement)),
        "noise.csv": table_columns(noise_table(measurement)),
    }
    from doe_kc.reports.page.links import link_pages
    from doe_kc.reports.page.measurement import write_measurement_page

    written = [write_columns(folder / name, table) for name, table in tables.items()]
    written += write_cars(reduced.cars, folder)
    written.append(write_measurement_page(folder / "report.html", measurement, reduced.cars))
    link_pages(folder.parent)
    if pictures == "none":
        return written
    from doe_kc.reports.measurement.figures import write_rig_figures

    return written + write_rig_figures(measurement, folder, workers=workers, pictures=pictures)


def reduced_document(reduced: Reduced) -> dict[str, Any]:
    """What `reduce --json` writes: characteristics with standard errors, ride height, noise."""
    characteristics = measured_characteristic_table(reduced.measurement)
    height = reduced.ride_height
    return {
        "name": reduced.measurement.manifest.name,
        "characteristics": dict(
            zip((r.entry.id for r in characteristics.rows), table_records(characteristics), strict=True)
        ),
        "ride_height_mm": None
        if height is None
        else {
            "estimate": height.estimate,
            "sd": height.sd,
            "consistency": height.consistency,
            "contributions": {
                c.response: {"estimate": c.estimate, "sd": c.sd, "used": c.used} for c in height.contributions
            },
        },
        "noise": table_records(noise_table(reduced.measurement)),
        **cars_entry(reduced.cars),
    }
