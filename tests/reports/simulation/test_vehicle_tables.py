"""K&C tables for vehicle models: signs by physics, numbers by the package's own characteristics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from doe_kc.axle import with_values
from doe_kc.characteristics import reduce_all
from doe_kc.curves import CurveSet
from doe_kc.reports.simulation.vehicle_tables import (
    ComplianceCoefficient,
    compliance_coefficients,
    kinematic_columns,
)
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests.axle_type_reference import nominal as nominal_of
from tests.reference import nominal

RADIUS = 310.0


@pytest.fixture(scope="module")
def curves() -> CurveSet:
    return curve_set(solve(nominal()))


@pytest.fixture(scope="module")
def coefficients(curves: CurveSet) -> dict[tuple[str, str], ComplianceCoefficient]:
    return {
        (c.key.removesuffix("_COEFFICIENT"), c.side): c
        for c in compliance_coefficients(nominal(), curves, RADIUS)
    }


def test_both_wheels_of_a_symmetric_axle_have_the_same(
    coefficients: dict[tuple[str, str], ComplianceCoefficient],
) -> None:
    for (key, side), c in coefficients.items():
        if side == "L":
            assert coefficients[key, "R"].value == pytest.approx(c.value, rel=1e-6), key


@pytest.mark.parametrize("key", ["C_LONG", "C_LAT", "CS_MZ", "CD_MY", "CI_FY"])
def test_what_any_suspension_does_is_positive(
    key: str, coefficients: dict[tuple[str, str], ComplianceCoefficient]
) -> None:
    """A load moves its own point its own way; one to the left at the ground tilts the top to the right."""
    assert coefficients[key, "L"].value > 0.0 and coefficients[key, "R"].value > 0.0


def test_coefficients_are_the_characteristics_in_other_words(
    curves: CurveSet, coefficients: dict[tuple[str, str], ComplianceCoefficient]
) -> None:
    values = reduce_all(curves)
    drive, brake = values["drive.drive_steer"] / 1000.0, values["brake.brake_steer"] / 1000.0
    assert coefficients["CT_FX", "L"].value == pytest.approx(drive, rel=1e-12)
    assert coefficients["CT_MY", "L"].value == pytest.approx((brake + drive) / (RADIUS / 1000.0), rel=1e-12)
    assert coefficients["CS_FY", "L"].value == pytest.approx(values["lateral.toe_change"] / 1000.0, rel=1e-12)


def test_the_aligning_moment_follows_the_columns_stiffness() -> None:
    """A soft column lets both wheels steer: CS_MZ falls as it gets stiffer, to what the arms give."""
    stiff = with_values(nominal(), {"scb.Tz": 50.0})
    rates = []
    for axle in (nominal(), stiff):
        solved = curve_set(solve(axle, ["lateral", "lateral_offset"]))
        rows = {(c.key, c.side): c.value for c in compliance_coefficients(axle, solved, RADIUS)}
        rates.append(rows["CS_MZ_COEFFICIENT", "L"])
    assert 0.0 < rates[1] < 0.7 * rates[0]


def test_the_auxiliary_roll_stiffness_is_the_bars(
    coefficients: dict[tuple[str, str], ComplianceCoefficient],
) -> None:
    """By virtual work with the links moving as the wheels, 4 k h^2, less what the tube moves less."""
    bar = math.radians(4.0 * 22.0 * 790.0**2) / 1000.0
    value = coefficients["MX_AUX", "axle"].value
    assert 0.85 * bar < value < bar
    none = nominal().changed({"arb.rate": 0.0})
    rows = list(compliance_coefficients(none, curve_set(solve(none, ["roll", "vertical"])), RADIUS))
    assert [c.key for c in rows] == ["MX_AUX_COEFFICIENT"]
    assert abs(rows[0].value) < 0.02 * bar


def test_kinematic_tables_keep_signs_and_both_wheels(curves: CurveSet) -> None:
    table = kinematic_columns(curves, "vertical")
    side, jounce = np.array(table["side"]), np.array(table["jounce_mm"])
    left, right = side == "L", side == "R"
    case = curves.cases["vertical"]
    assert np.allclose(np.array(table["toe_deg"])[left], case.mean["toe"][0])
    assert np.allclose(np.array(table["x_mm"])[left], -case.mean["wc_x"][0])
    outwards = np.array(table["y_mm"])
    assert np.allclose(outwards[left], -case.mean["wc_y"][0]) and np.allclose(outwards[left], outwards[right])
    assert np.all(np.diff(np.array(table["load_N"])[left][np.argsort(jounce[left])]) > 0)


def test_an_axle_without_a_rack_has_no_steer() -> None:
    curves = curve_set(solve(nominal_of("five_link_rear")))
    assert "steer" not in curves.cases
    keys = {c.key for c in compliance_coefficients(nominal_of("five_link_rear"), curves, 322.0)}
    assert {"CS_FY_COEFFICIENT", "CS_MZ_COEFFICIENT", "C_LAT_COEFFICIENT"} <= keys
