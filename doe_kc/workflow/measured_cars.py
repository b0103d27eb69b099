"""The measured cars that a tolerance study draws beside the drawn ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from doe_kc.ground.errors import InputError
from doe_kc.measurement import Measurement
from doe_kc.measurement.rig_state import rig_state
from doe_kc.production_scatter.result import MeasuredCar
from doe_kc.study import Study
from doe_kc.workflow.measure import study_measurement


def car_folders(study: Study) -> list[Path]:
    """Folders of the measured cars; InputError for one that is not there, or was measured in another state
    than the study's axle has."""
    if study.tolerance.cars is None:
        return list(study.measurements)
    folders = [study.folder / name for name in study.tolerance.cars]
    for folder in folders:
        where = f"{study.source}: tolerance.cars: {folder}"
        if not folder.exists():
            raise InputError(f"{where}: there is no such folder; expected one that holds test.toml.")
        if rig_state(folder).arb != study.state.arb:
            raise InputError(
                f"{where}: the anti-roll bar was {rig_state(folder).arb}, of the study's axle it is "
                f"{study.state.arb}; leave this car out, or name its records as the study's measurement."
            )
    return folders


def measured_cars(study: Study) -> list[tuple[Path, Measurement]]:
    """The reduced records of every car."""
    return [(f, study_measurement(replace(study, measurements=(f,)))) for f in car_folders(study)]


def named_cars(cars: Sequence[tuple[Path, Measurement]]) -> list[MeasuredCar]:
    """By the name of the records; with the folder's where two have one name."""
    names = [m.manifest.name for _, m in cars]
    out = []
    for folder, m in cars:
        name = m.manifest.name if names.count(m.manifest.name) == 1 else f"{m.manifest.name} ({folder.name})"
        out.append(MeasuredCar(name, {k: e.value for k, e in m.characteristics.items()}, m.curves))
    return out
