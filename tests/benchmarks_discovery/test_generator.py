"""Hidden cars: the same for the same seed, readable, and as noisy as they say."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from benchmarks.discovery.generator import RECORDS, HiddenCar, hidden_car
from benchmarks.discovery.suites import SUITES
from benchmarks.discovery.vehicles import nominal_axle, write_nominal
from doe_kc.axle_file import read_axle
from doe_kc.correlation.likelihood import build_likelihood
from doe_kc.measurement import reduce_measurement
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.targets import build_targets

LEAST, MOST = 0.9, 1.15


def test_same_seed_same_car(plain: HiddenCar, plain_folder: Path, tmp_path: Path) -> None:
    again = hidden_car(3, "null", clutter_in=False, faults=False)
    assert again.key == plain.key
    again.write(tmp_path)
    for file in sorted(plain_folder.rglob("*.*")):
        assert (tmp_path / file.relative_to(plain_folder)).read_bytes() == file.read_bytes()


def test_other_seed_other_car(plain: HiddenCar) -> None:
    other = hidden_car(4, "null", clutter_in=False, faults=False)
    assert other.seal != plain.seal
    assert other.car.axle.values["LLF.x@L"] != plain.car.axle.values["LLF.x@L"]


def test_cars_of_a_series_share_what_is_hidden_and_nothing_else() -> None:
    first, second = (hidden_car(3, "single", number=n) for n in (0, 1))
    assert first.content.hidden == second.content.hidden and first.car.clutter == second.car.clutter
    assert first.car.axle.values["LLF.x@L"] != second.car.axle.values["LLF.x@L"]
    assert first.levels != second.levels and first.error_seed != second.error_seed
    assert first.error_seed == first.seed, "the first car is that of the sealed keys"


def test_records_have_the_form_of_a_rig(plain_folder: Path) -> None:
    files = sorted(p.name for p in (plain_folder / RECORDS).iterdir())
    assert len(files) == 8 * 3 + 1
    head, *rows = (plain_folder / RECORDS / "roll.csv").read_text().splitlines()
    assert head.startswith("time [s],roll [deg],toe_L [deg],camber_L [deg],caster_L [deg],wc_x_L [mm]")
    assert len(rows) == 512
    assert all(len(cell.partition(".")[2]) <= 4 for cell in rows[100].split(",")[2:])


def test_truth_fits_its_own_records_to_noise(plain: HiddenCar, plain_folder: Path) -> None:
    """By the reduction that a user has, warnings being errors."""
    assert LEAST < _misfit(plain, plain_folder) < MOST


@pytest.mark.parametrize("suite", ["single", "wrong_priors"])
def test_other_vehicles_fit_to_noise(suite: str, tmp_path: Path) -> None:
    """Another base vehicle, friction in its steady cycle: what is hidden shifts no noise."""
    car = _with_effect("steering_friction" if suite == "single" else "ride_height_offset", suite)
    assert LEAST < _misfit(car, car.write(tmp_path)) < MOST


def _with_effect(ident: str, suite: str) -> HiddenCar:
    for seed in range(13):
        content = SUITES[suite](seed, np.random.default_rng(0), nominal_axle("shifted", seed))
        if content.hidden[0].id == ident:
            return hidden_car(seed, suite, base="shifted", clutter_in=False, faults=False)
    raise AssertionError(f"no {ident} among thirteen cars of {suite}")


def _misfit(car: HiddenCar, folder: Path) -> float:
    """Chi-square per datum of the true axle."""
    measured = reduce_measurement(folder / RECORDS)
    targets = build_targets(car.nominal, measured, [], [], source="test")
    likelihood = build_likelihood(car.nominal, measured, targets)
    residual = likelihood.residual(curve_set(solve(car.car.true_axle())), np.zeros(0))
    return float(np.mean(residual**2))


def test_nominal_is_another_vehicle_and_reads_back(tmp_path: Path) -> None:
    example, shifted = nominal_axle("example", 1), nominal_axle("shifted", 1)
    moved = [abs(shifted.values[k] - example.values[k]) for k in example.values if k.startswith("RIB.")]
    assert 0.1 < max(moved) < 10.0
    again = read_axle(write_nominal(shifted, tmp_path / "axle.toml"))
    assert again.values == pytest.approx(dict(shifted.values))


def test_nominal_tells_nothing_of_the_car(plain: HiddenCar, plain_folder: Path) -> None:
    assert read_axle(plain_folder / "axle.toml").values == plain.nominal.values
    key = tomllib.loads(plain.key)
    assert len(key["values"]) > 100
    assert "effects" not in (plain_folder / "axle.toml").read_text()


def test_scatter_is_within_what_it_says(plain: HiddenCar) -> None:
    at, nominal = plain.car.axle.values, plain.nominal.values
    moved = [at[k] - nominal[k] for k in nominal if k[:3] in ("LLF", "LWB", "RIB") and k.endswith("@L")]
    assert 0.3 < np.std(moved) < 2.0
    assert all(0.48 < at[f"llr.{a}@{s}"] < 2.1 for a in ("Fx", "Fy", "Tz") for s in "LR")
    assert at["llr.Fx@L"] != at["llr.Fx@R"]
