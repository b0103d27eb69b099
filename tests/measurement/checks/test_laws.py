"""What slopes of sound cars may be, on every axle type."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.axle_types import BUILT_IN
from doe_kc.examples import example_folder
from doe_kc.load_cases import CASE_ORDER
from doe_kc.measurement.checks.identity.faults import fault_set
from doe_kc.measurement.checks.identity.laws import Expectation, misfit
from doe_kc.measurement.checks.identity.slopes import SlopeTable, column, model_slopes, row
from doe_kc.measurement.checks.signs import TOLD_FALL
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve

USUAL_LOAD = 4000.0


@cache
def expectation(name: str) -> Expectation:
    return Expectation(
        model_slopes(curve_set(solve(read_axle(example_folder(name) / "axle.toml")))), USUAL_LOAD
    )


def measured(slope: np.ndarray) -> SlopeTable:
    rest = np.where(np.isnan(slope[:, column("tyre_load")]), np.nan, USUAL_LOAD)
    return SlopeTable(slope, rest, np.full(slope.shape, np.nan))


def told(name: str, slope: np.ndarray) -> str:
    """Words of the error that explains the slopes best, empty where none does."""
    table, cases = measured(slope), tuple(c for c in CASE_ORDER if np.isfinite(slope[row(c)]).any())
    faults = fault_set(cases, counter_phase=False)
    left = misfit(faults.undone(table), expectation(name), faults.source) + faults.price
    fall = float(misfit(table.batch(), expectation(name))[0]) - left
    return faults.members[int(np.argmax(fall))].words if fall.max() > TOLD_FALL else ""


@pytest.mark.parametrize("name", BUILT_IN)
def test_a_car_that_is_as_its_model_has_no_error(name: str) -> None:
    own = expectation(name).model
    assert float(misfit(measured(own).batch(), expectation(name))[0]) < TOLD_FALL
    assert told(name, own) == ""


@pytest.mark.parametrize("name", BUILT_IN)
def test_compliances_that_the_model_lacks_are_no_error_of_a_unit(name: str) -> None:
    """Several times softer in one load case, as with a soft sub-frame under lateral forces that oppose each
    other."""
    slope = expectation(name).model.copy()
    at = row("lateral_opposite")
    slope[at, : column("tyre_load")] *= 4.0
    assert told(name, slope) == ""


@pytest.mark.parametrize("name", BUILT_IN)
def test_camber_in_roll_against_the_road_is_a_technique(name: str) -> None:
    slope = expectation(name).model.copy()
    slope[row("roll"), column("camber")] += [-1.0, 1.0]
    assert told(name, slope) == ""


def test_a_wheel_centre_that_goes_against_the_lateral_force_is_no_error_if_its_contact_point_does_not() -> (
    None
):
    """As with 4900 Nm/deg between hub and strut: the wheel tilts about a point above its centre."""
    slope = expectation("mcpherson_front").model.copy()
    for case, centre, camber in (
        ("lateral", -1.4e-6, 5.8e-5),
        ("lateral_opposite", -4.7e-5, 5.2e-5),
        ("lateral_offset", -3.7e-5, 6.5e-5),
    ):
        mirror = -1.0 if case == "lateral_opposite" else 1.0
        slope[row(case), column("wc_y")] = centre, mirror * centre
        slope[row(case), column("camber")] = camber, -mirror * camber
    assert told("mcpherson_front", slope) == ""


def test_total_toe_and_exchanged_lateral_records_are_told() -> None:
    name = "mcpherson_front"
    slope = expectation(name).model.copy()
    slope[:, column("toe")] *= 2.0
    assert told(name, slope) == "toe is the total of both wheels in every load case"
    slope = expectation(name).model.copy()
    a, b = row("lateral"), row("lateral_offset")
    slope[[a, b]] = slope[[b, a]]
    assert told(name, slope) == "the records of lateral and lateral_offset are exchanged"
