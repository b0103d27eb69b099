"""Reduce: rig records to curves, noise, gradients, targets, ride height and pictures."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from doe_kc.curves import CurveSet
from doe_kc.ground.output import write_csv
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.measurement import (
    Measurement,
    RideHeight,
    infer_ride_height,
    measurement_to_frames,
    reduce_measurement,
)
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from doe_kc.study import Study
from doe_kc.workflow.rig_checks import axle_curves, refuse_faulty, rig_findings
from doe_kc.workflow.scatter import vertical_scatter
from doe_kc.workflow.setup import setup_differences

log = logging.getLogger("doe_kc")


@dataclass(frozen=True)
class Reduced:
    """ride_height: difference to the study's axle; None without a `vertical` record."""

    measurement: Measurement
    ride_height: RideHeight | None


def study_records(study: Study) -> Reduced | None:
    """The study's reduced records; None when it names no measurement."""
    return reduce_records(study, solve(study.axle)) if study.measurement is not None else None


def study_measurement(study: Study, model: CurveSet | None = None) -> Measurement:
    """The study's reduced records; InputError when it names none, or where physics says that they are wrong.

    Warns where the set-up differs and of what looks wrong. model: curves of the study's axle, solved if None.
    """
    measurement = reduce_measurement(
        study.measured(), windows=study.windows, half_track=study.axle.half_track
    )
    for sentence in setup_differences(study.axle, measurement.manifest):
        log.warning(sentence)
    path = study.measured()
    source = path / "test.toml" if path.is_dir() else path
    model = axle_curves(study.axle) if model is None else model
    refuse_faulty(rig_findings(source, measurement.manifest, measurement.runs, model))
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
    return Reduced(measurement, height)


def write_reduced(
    reduced: Reduced, folder: Path, *, workers: int | None = None, pictures: PictureFormat = PNG
) -> list[Path]:
    """curves.csv, characteristics.csv, gradients.csv, noise.csv and one picture a load case."""
    frames = measurement_to_frames(reduced.measurement)
    tables = {
        "curves.csv": frames.curves,
        "characteristics.csv": frames.characteristics,
        "gradients.csv": frames.gradients,
        "noise.csv": frames.noise,
    }
    written = [write_csv(folder / name, frame) for name, frame in tables.items()]
    if pictures == "none":
        return written
    from doe_kc.report.rig_figures import write_rig_figures

    return written + write_rig_figures(reduced.measurement, folder, workers=workers, pictures=pictures)


def reduced_document(reduced: Reduced) -> dict[str, Any]:
    """What `reduce --json` writes: characteristics with standard errors, ride height, noise."""
    frames = measurement_to_frames(reduced.measurement)
    height = reduced.ride_height
    return {
        "name": reduced.measurement.manifest.name,
        "characteristics": {
            row["name"]: {k: row[k] for k in ("value", "sd", "unit", "load_case")}
            for row in frames.characteristics.to_dict("records")
        },
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
        "noise": frames.noise.to_dict("records"),
    }
