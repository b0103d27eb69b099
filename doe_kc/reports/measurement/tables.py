"""The tables of a reduction: characteristics, gradients and noise of the rig records, and their curves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS, Characteristic
from doe_kc.curves import RESPONSE_UNITS, SIDES
from doe_kc.ground.numbers import with_sd
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import Gradient, GradientEstimate, Measurement, NoiseModel
from doe_kc.reports.characteristic_columns import CHARACTERISTIC_COLUMNS
from doe_kc.reports.table import Column, PageCell, PageLayout, Table

if TYPE_CHECKING:
    import pandas as pd

CURVE_COLUMNS = (
    "load_case", "input", "input_unit", "side", "response", "unit", "mean", "half_width", "sd",
)  # fmt: skip


@dataclass(frozen=True)
class MeasuredCharacteristic:
    """A characteristic as the records show it; nan where they do not."""

    entry: Characteristic
    estimate: GradientEstimate


@dataclass(frozen=True)
class CurveNoise:
    """The error model of one response in one load case."""

    load_case: str
    response: str
    model: NoiseModel


MEASURED_CHARACTERISTIC_COLUMNS: tuple[Column[MeasuredCharacteristic], ...] = (
    *CHARACTERISTIC_COLUMNS,
    Column("value", "Value", lambda r: r.estimate.value, json="value", page=PageCell(
        "Measured ± sd", text=lambda r: with_sd(r.estimate.value, r.estimate.sd), strong=lambda r: True,
        order=lambda r: r.estimate.value, style="n")),
    Column("sd", "Standard error", lambda r: r.estimate.sd, json="sd"),
)  # fmt: skip
GRADIENT_COLUMNS: tuple[Column[Gradient], ...] = (
    Column("load_case", "Load case", lambda g: g.load_case),
    Column("response", "Response", lambda g: g.response),
    Column("side", "Side", lambda g: g.side),
    Column("unit", "Unit", lambda g: g.unit),
    Column("value", "Value", lambda g: g.value),
    Column("sd", "Standard error", lambda g: g.sd),
    Column("window", "Fit window", lambda g: g.window),
    Column("input_unit", "Unit of the window", lambda g: g.unit.split("/")[1]),
)


def _part(key: str, head: str, of: Callable[[NoiseModel], Any]) -> Column[CurveNoise]:
    return Column(key, head, lambda r: of(r.model), json=key)


NOISE_COLUMNS: tuple[Column[CurveNoise], ...] = (
    Column("load_case", "Load case", lambda r: r.load_case, json="load_case"),
    Column("response", "Response", lambda r: r.response, json="response"),
    Column("unit", "Unit", lambda r: RESPONSE_UNITS[r.response], json="unit"),
    _part("white", "White sd", attrgetter("white")),
    _part("offset", "Offset sd", attrgetter("components.offset")),
    _part("gain", "Gain sd", attrgetter("components.gain")),
    _part("smooth", "Smooth sd", attrgetter("components.smooth")),
    _part("length", "Its length", attrgetter("components.length")),
    _part("loop", "Loop sd", attrgetter("loop")),
    _part("dof", "Degrees of freedom", attrgetter("components.dof")),
    _part("source", "Source", attrgetter("components.source")),
)


def measured_characteristic_table(measurement: Measurement) -> Table[MeasuredCharacteristic]:
    """One row a characteristic that the records show, with its standard error."""
    rows = [
        MeasuredCharacteristic(CHARACTERISTICS[i], e)
        for i, e in measurement.characteristics.items()
        if math.isfinite(e.value)
    ]
    layout = PageLayout[MeasuredCharacteristic]("measured-table", "Characteristics", filtered=True)
    remark = "As the records show them."
    return Table("Characteristics", remark, MEASURED_CHARACTERISTIC_COLUMNS, rows, page=layout)


def gradient_table(measurement: Measurement) -> Table[Gradient]:
    """One row a curve: the slope about the static state."""
    return Table(
        "Gradients", "Per unit of the input, in the window.", GRADIENT_COLUMNS, measurement.gradients
    )


def noise_table(measurement: Measurement) -> Table[CurveNoise]:
    """One row a curve: standard deviations of its error's components, deg, mm or N."""
    rows = [
        CurveNoise(load_case, response, model)
        for load_case, models in measurement.noise.items()
        for response, model in models.items()
    ]
    return Table("Noise", "Standard deviations of the parts of each curve's error.", NOISE_COLUMNS, rows)


def measured_curve_columns(measurement: Measurement) -> dict[str, Any]:
    """One row a point of a curve: `CURVE_COLUMNS`, sd its standard error.

    Array by array, no `Table`: of ten thousands of points a row each would take longer than to reduce them.
    """
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


def measured_curve_frame(measurement: Measurement) -> pd.DataFrame:
    """`measured_curve_columns` as a data frame."""
    import pandas as pd

    return pd.DataFrame(measured_curve_columns(measurement))
