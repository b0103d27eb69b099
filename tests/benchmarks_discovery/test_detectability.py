"""How far an effect stands out of what nobody knows of a car."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import least_squares

from benchmarks.discovery.car import Car
from benchmarks.discovery.chance import stream
from benchmarks.discovery.clutter import SIZE_SD, TRAVEL_SD, clutter, unlike
from benchmarks.discovery.detectability import detectability
from benchmarks.discovery.generator import RECORDS, HiddenCar
from benchmarks.discovery.hidden import Hidden
from doe_kc.axle.parameters import parameter_value, with_values
from doe_kc.correlation.likelihood import Likelihood, record_likelihood
from doe_kc.effects._friction import TRAVEL
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement import reduce_measurement
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve

MOUNT = Hidden("rack_mount_compliance", 1.85, None, {"k_N_mm": 3240.0}, {"k_N_mm": 3240.0}, ("k_N_mm",))
OPTIONS = {"force_N": 11.8, TRAVEL: 0.062, "law": "iwan"}
FRICTION = Hidden("steering_friction", 0.047, None, OPTIONS, {"force_N": 11.8})


@pytest.fixture(scope="module")
def likelihood(plain: HiddenCar, plain_folder: Path) -> Likelihood:
    return record_likelihood(plain.nominal, reduce_measurement(plain_folder / RECORDS))


def _residual(car: Car, likelihood: Likelihood) -> FloatArray:
    return likelihood.residual(curve_set(solve(car.true_axle())), np.zeros(0))


def test_what_a_small_friction_and_the_column_do_too_does_not_stand_out(
    plain: HiddenCar, likelihood: Likelihood
) -> None:
    """Against curves that are solved: a softer column and less friction of a longer travel in its place."""
    car = Car(plain.car.axle, (MOUNT,), (FRICTION,), None, plain.car.warp)
    column = parameter_value(car.axle, "scb.Tz")
    full = _residual(car, likelihood)

    def other(x: FloatArray) -> FloatArray:
        """x: ln of the column's stiffness, of the friction's force and travel, all over the car's."""
        options = {**OPTIONS, "force_N": 11.8 * np.exp(x[1]), TRAVEL: 0.062 * np.exp(x[2])}
        axle = with_values(car.axle, {"scb.Tz": column * float(np.exp(x[0]))})
        without = Car(axle, (), (replace(FRICTION, options=options),), None, car.warp)
        return np.asarray(_residual(without, likelihood) - full)

    alike = least_squares(other, np.array([-0.4, -0.5, 0.5]), diff_step=1e-3, max_nfev=12)
    assert np.linalg.norm(other(np.zeros(3))) > 200.0, "sd that the mount changes the curves by"
    assert np.linalg.norm(alike.fun) < 3.0, "and that are left once others of the car are unlike"
    assert np.all(np.abs(alike.x) < 1.0)
    found = detectability(plain.nominal, car, likelihood)["rack_mount_compliance"]
    assert found.strength < 10.0
    known = detectability(plain.nominal, replace(car, clutter=()), likelihood)["rack_mount_compliance"]
    assert known.strength < 3.0, "without any friction the column does the very same"


def test_what_nothing_else_does_stands_out(plain: HiddenCar, likelihood: Likelihood) -> None:
    low = Hidden("ride_height_offset", 1.0, None, {"offset_mm": 7.0}, {"offset_mm": 7.0})
    car = Car(plain.car.axle, (low,), (FRICTION,), None, plain.car.warp)
    assert detectability(plain.nominal, car, likelihood)["ride_height_offset"].strength > 100.0


def test_small_effects_are_unlike_in_size_and_travel(plain: HiddenCar) -> None:
    (larger, longer) = unlike(FRICTION)
    assert larger.options == {**OPTIONS, "force_N": pytest.approx(11.8 * (1.0 + SIZE_SD))}
    assert longer.options == {**OPTIONS, TRAVEL: pytest.approx(0.062 * np.exp(TRAVEL_SD))}
    (softer,) = unlike(MOUNT)
    assert softer.options["k_N_mm"] == pytest.approx(3240.0 / (1.0 + SIZE_SD))
    small = {c.id: c for c in clutter(plain.nominal, stream(1, "clutter"), ())}
    (stiffer,) = unlike(small["bushing_progression"])
    added = small["bushing_progression"].parameters["LLR[1]"]
    was, now = small["bushing_progression"].options["LLR"][1], stiffer.options["LLR"][1]
    assert now - was == pytest.approx(SIZE_SD * added) and was > added
    (pushed,) = unlike(small["bushing_preload"])
    assert pushed.options["LLR"][0] == pytest.approx(
        (1.0 + SIZE_SD) * small["bushing_preload"].options["LLR"][0]
    )


def test_the_spread_of_sizes_is_that_of_the_cars(plain: HiddenCar) -> None:
    drawn = [c for seed in range(300) for c in clutter(plain.nominal, stream(seed, "clutter"), ())]
    frictions = [c for c in drawn if c.id == "steering_friction"]
    sizes = np.array([c.size for c in frictions])
    assert sizes.std() / sizes.mean() == pytest.approx(SIZE_SD, rel=0.1)
    travels = np.log([c.options[TRAVEL] for c in frictions])
    assert travels.std() == pytest.approx(TRAVEL_SD, rel=0.1)
