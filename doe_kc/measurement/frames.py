"""A measurement as tidy tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import RESPONSE_UNITS, SIDES
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.reduction import Measurement

if TYPE_CHECKING:
    import pandas as pd

CURVE_COLUMNS = (
    "load_case", "input", "input_unit", "side", "response", "unit", "mean", "half_width", "sd",
)  # fmt: skip
CHARACTERISTIC_COLUMNS = ("name", "load_case", "response", "unit", "value", "sd")
GRADIENT_COLUMNS = (
    "load_case", "response", "side", "unit", "value", "sd", "window", "input_unit",
)  # fmt: skip
NOISE_COLUMNS = (
    "load_case", "response", "unit", "white", "offset", "gain",
    "smooth", "length", "loop", "dof", "source",
)  # fmt: skip


@dataclass(frozen=True)
class MeasurementFrames:
    """curves: one row per point; characteristics: one per id; gradients, noise: one per curve."""

    curves: pd.DataFrame
    characteristics: pd.DataFrame
    gradients: pd.DataFrame
    noise: pd.DataFrame


@dataclass(frozen=True)
class MeasurementColumns:
    """As `MeasurementFrames`, each table as its columns."""

    curves: dict[str, Any]
    characteristics: dict[str, Any]
    gradients: dict[str, Any]
    noise: dict[str, Any]


def measurement_to_columns(measurement: Measurement) -> MeasurementColumns:
    """All tables; units in columns of their own (deg, mm, N and per input unit), sd = standard error."""
    return MeasurementColumns(
        curves=_curves(measurement),
        characteristics=_characteristics(measurement),
        gradients=_gradients(measurement),
        noise=_noise(measurement),
    )


def measurement_to_frames(measurement: Measurement) -> MeasurementFrames:
    """`measurement_to_columns` as data frames."""
    import pandas as pd

    tables = measurement_to_columns(measurement)
    return MeasurementFrames(
        pd.DataFrame(tables.curves),
        pd.DataFrame(tables.characteristics),
        pd.DataFrame(tables.gradients),
        pd.DataFrame(tables.noise),
    )


def _curves(measurement: Measurement) -> dict[str, Any]:
    labels: list[tuple[str, str, str, str, str]] = []
    sizes: list[int] = []
    numbers: list[tuple[FloatArray, ...]] = []
    for name, case in measurement.curves.cases.items():
        for response, curve in case.mean.items():
            for side, label in enumerate(SIDES):
                variance = np.diag(measurement.noise[name][response].covariance(side=side))
                sd = np.sqrt(np.maximum(variance, 0.0))
                labels.append((name, case.input_unit, label, response, RESPONSE_UNITS[response]))
                sizes.append(case.input.size)
                numbers.append((case.input, curve[side], case.half_width[response][side], sd))
    names = ("load_case", "input_unit", "side", "response", "unit")
    texts = zip(names, zip(*labels, strict=True), strict=True)
    columns: dict[str, Any] = {n: np.repeat(np.array(t, dtype=object), sizes) for n, t in texts}
    values = zip(("input", "mean", "half_width", "sd"), zip(*numbers, strict=True), strict=True)
    columns |= {n: np.concatenate(v) for n, v in values}
    return {name: columns[name] for name in CURVE_COLUMNS}


def _characteristics(measurement: Measurement) -> dict[str, Any]:
    rows = []
    for ident, estimate in measurement.characteristics.items():
        entry = CHARACTERISTICS[ident]
        rows.append((ident, entry.load_case, entry.response, entry.unit, estimate.value, estimate.sd))
    return _columns(rows, CHARACTERISTIC_COLUMNS)


def _gradients(measurement: Measurement) -> dict[str, Any]:
    rows = [
        (g.load_case, g.response, g.side, g.unit, g.value, g.sd, g.window, g.unit.split("/")[1])
        for g in measurement.gradients
    ]
    return _columns(rows, GRADIENT_COLUMNS)


def _noise(measurement: Measurement) -> dict[str, Any]:
    rows = []
    for name, models in measurement.noise.items():
        for response, model in models.items():
            c = model.components
            sds = (model.white, c.offset, c.gain, c.smooth, c.length, model.loop)
            rows.append((name, response, RESPONSE_UNITS[response], *sds, c.dof, c.source))
    return _columns(rows, NOISE_COLUMNS)


def _columns(rows: list[Any], names: tuple[str, ...]) -> dict[str, Any]:
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}
