from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from doe_kc.curves import RIG_RESPONSES, CurveSet
from doe_kc.ground.errors import InputError
from doe_kc.measurement import Measurement, infer_ride_height
from doe_kc.measurement.shifted_curves import KinkedCurve, ShiftedCurves
from tests.measurement.synthetic import reference


def test_the_solved_offset_of_7_mm_is_found() -> None:
    found = infer_ride_height(reference("effect_ride_height_offset"), reference("nominal"))
    assert found.estimate == pytest.approx(7.0, abs=0.2)
    assert 0.3 < found.sd < 1.5
    alone = {c.response: c for c in found.contributions}
    assert alone["wc_y"].estimate == pytest.approx(7.0, abs=0.1)
    assert alone["camber"].estimate == pytest.approx(7.0, abs=0.1)
    assert alone["tyre_load"].estimate == pytest.approx(7.0, abs=0.2)
    assert alone["static_load"].estimate == pytest.approx(7.0, abs=0.1)
    assert not alone["static_load"].used


def test_seen_the_other_way_round_it_is_minus_7_mm() -> None:
    found = infer_ride_height(reference("nominal"), reference("effect_ride_height_offset"))
    assert found.estimate == pytest.approx(-7.0, abs=0.3)


def test_an_axle_has_no_offset_to_itself() -> None:
    found = infer_ride_height(reference("nominal"), reference("nominal"))
    assert found.estimate == pytest.approx(0.0, abs=1e-4)
    assert found.consistency == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("number", [1, 2, 3])
def test_scatter_of_hardpoints_and_bushings_is_no_ride_height(number: int) -> None:
    found = infer_ride_height(reference(f"variant_{number}"), reference("nominal"))
    assert abs(found.estimate) < 2.5 * found.sd
    assert abs(found.estimate) < 2.5 and found.sd < 2.0


@pytest.mark.parametrize(
    "effect", ["hub_compliance", "strut_bending", "subframe_flexibility", "bushing_preload"]
)
def test_other_effects_are_no_ride_height(effect: str) -> None:
    found = infer_ride_height(reference(f"effect_{effect}"), reference("nominal"))
    assert abs(found.estimate) < 0.3


def test_the_real_car_with_noise(car_a: Measurement) -> None:
    found = infer_ride_height(car_a.curves, reference("nominal"), car_a.noise["vertical"])
    assert abs(found.estimate) < 2.0 and 0.3 < found.sd < 1.5


def test_clearance_scatter_sets_the_weight_of_the_contact() -> None:
    sds = [
        infer_ride_height(reference("nominal"), reference("nominal"), stop_clearance_sd=sd).sd
        for sd in (0.1, 1.0, 30.0)
    ]
    assert sds[0] < 0.3 < sds[1] < sds[2] < 1.2


def test_scatter_may_come_from_the_model() -> None:
    """One parameter that tilts the track curve only: the other responses still tell the offset."""
    nominal = reference("nominal")
    case = nominal.cases["vertical"]
    modes = {r: np.zeros((case.input.size, 1)) for r in RIG_RESPONSES}
    modes["wc_y"][:, 0] = 5e-3 * case.mean["wc_z"][0]
    found = infer_ride_height(reference("effect_ride_height_offset"), nominal, scatter=modes)
    assert found.estimate == pytest.approx(7.0, abs=0.2)


def test_what_tells_no_ride_height_is_refused() -> None:
    nominal = reference("nominal")
    without = dataclasses.replace(nominal, cases={})
    with pytest.raises(InputError, match="no load case vertical"):
        infer_ride_height(without, nominal)
    with pytest.raises(InputError, match=r"covers ±40 mm, expected at least ±52 mm"):
        infer_ride_height(_clipped(nominal, 40.0), nominal)


def _clipped(curves: CurveSet, reach: float) -> CurveSet:
    case = curves.cases["vertical"]
    kept = np.abs(case.input) <= reach
    mean = {r: c[:, kept] for r, c in case.mean.items()}
    cut = dataclasses.replace(case, input=case.input[kept], mean=mean)
    return dataclasses.replace(curves, cases={"vertical": cut})


def test_a_kink_between_points_stays_sharp() -> None:
    grid = np.arange(-20.0, 41.0, 5.0)

    def curve(u: np.ndarray) -> np.ndarray:
        return 27.0 * u + 0.02 * u**2 + 20.0 * np.maximum(u - 12.3, 0.0)

    kinked = KinkedCurve(grid, curve(grid))
    at = np.linspace(-19.0, 39.0, 400)
    assert kinked.kinked_cells == (6,)
    in_cell = (at > 10.0) & (at < 15.0)
    assert np.abs(kinked(at) - curve(at))[in_cell].max() < 1e-6
    assert np.abs(kinked.smooth(at) - curve(at))[in_cell].max() > 10.0
    assert np.abs(kinked(at) - curve(at)).max() < 4.0  # PCHIP in the cells beside the kink


def test_shifted_curves_are_those_of_the_raised_axle() -> None:
    """Against the independent solver, which raised the pads by 7 mm and solved again."""
    shifted = ShiftedCurves.of(reference("nominal").cases["vertical"])
    raised = reference("effect_ride_height_offset").cases["vertical"]
    inside = np.abs(raised.input) <= 70.0
    travel = raised.mean["wc_z"][0][inside]
    for response, limit in (("toe", 0.005), ("camber", 0.002), ("wc_y", 0.01), ("wc_x", 0.02)):
        predicted = shifted.kinematic(response, travel, 7.0)
        assert np.abs(predicted - raised.mean[response][0][inside]).max() < limit, response
    load = shifted.load(raised.input[inside], 7.0)
    assert np.abs(load - raised.mean["tyre_load"][0][inside]).max() < 25.0
