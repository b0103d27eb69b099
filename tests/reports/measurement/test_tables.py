"""Tables of the rig records."""

from __future__ import annotations

import pytest

from doe_kc.measurement import Measurement, reduce_measurement
from doe_kc.reports.measurement.tables import (
    CURVE_COLUMNS,
    gradient_table,
    measured_characteristic_table,
    measured_curve_frame,
    noise_table,
)
from doe_kc.reports.render.csv import table_frame
from doe_kc.reports.render.json import table_records
from tests.measurement.synthetic import EXAMPLE


@pytest.fixture(scope="module")
def car() -> Measurement:
    return reduce_measurement(EXAMPLE / "test.toml")


def test_the_tables_are_tidy(car: Measurement) -> None:
    curves = measured_curve_frame(car)
    assert tuple(curves.columns) == CURVE_COLUMNS
    points = sum(c.input.size for c in car.curves.cases.values())
    assert len(curves) == points * 14
    assert not curves.isna().any().any()
    characteristics = table_frame(measured_characteristic_table(car)).set_index("name")
    row = characteristics.loc["vertical.ride_rate"]
    assert row["unit"] == "N/mm" and row["value"] == pytest.approx(26.26, abs=0.01)
    gradients, noise = table_frame(gradient_table(car)), table_frame(noise_table(car))
    assert len(gradients) == 112 and len(noise) == 56
    assert set(gradients["input_unit"]) == {"N", "deg", "mm"}


def test_noise_in_a_document_is_that_of_its_model(car: Measurement) -> None:
    record = table_records(noise_table(car))[0]
    model = car.noise[str(record["load_case"])][str(record["response"])]
    assert record["white"] == model.white and record["gain"] == model.components.gain
