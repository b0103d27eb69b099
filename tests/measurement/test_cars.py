"""Several measured cars as one measurement."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pandas as pd
import pytest

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import InputError
from doe_kc.measurement import Measurement, car_figures, reduce_cars, reduce_measurement
from doe_kc.measurement.car_scatter import figures_of, scatter_sd
from tests.measurement.synthetic import write_rig

CASES = ("vertical", "brake")
TOE = (0.95, 1.0, 1.08)
"""Factor of every car's toe."""


def scaled(folder: Path, column: str, factor: float) -> None:
    for path in folder.glob("*.csv"):
        table = pd.read_csv(path)
        table[[c for c in table if c.startswith(column)]] *= factor
        table.to_csv(path, index=False)


def cars(
    folder: Path, factors: tuple[float, ...] = TOE, cases: tuple[str, ...] = CASES, runs: int = 3
) -> list[Path]:
    out = []
    for k, factor in enumerate(factors):
        place = folder / f"rig_{k + 1}"
        place.mkdir()
        write_rig(place, cases=cases, seed=100 + k, runs=runs)
        scaled(place, "toe", factor)
        out.append(place)
    return out


@lru_cache(maxsize=1)
def several() -> tuple[Measurement, tuple[Measurement, ...]]:
    """The mean, and each car reduced by itself."""
    folders = cars(Path(mkdtemp()))
    return reduce_cars(folders), tuple(reduce_measurement(f) for f in folders)


def test_the_mean_is_that_of_the_cars_reduced_by_themselves() -> None:
    mean, single = several()
    for case in CASES:
        for response, rows in mean.curves.cases[case].mean.items():
            alone = [m.curves.cases[case].mean[response] for m in single]
            np.testing.assert_allclose(rows, np.mean(alone, axis=0), rtol=1e-12, atol=1e-12)
            half = [m.curves.cases[case].half_width[response] for m in single]
            np.testing.assert_allclose(
                mean.curves.cases[case].half_width[response], np.mean(half, axis=0), atol=1e-12
            )
    assert mean.manifest.name == "mean of 3 cars" and len(mean.cars) == 3
    assert mean.curves.static is not None and mean.curves.static["camber"] == pytest.approx([-0.5, -0.5])
    assert mean.manifest.alignment is not None
    assert mean.manifest.alignment.sd.toe_deg == pytest.approx(0.01 / np.sqrt(3))


def test_noise_of_the_mean_is_that_of_the_cars_over_their_number() -> None:
    mean, _ = several()
    for case, models in mean.noise.items():
        for response, model in models.items():
            own = [car.noise[case][response].covariance() for car in mean.cars]
            expected = np.sum(own, axis=0) / 9.0
            assert np.abs(model.covariance() - expected).max() < 0.01 * expected.max()
            assert model.components.dof == 6 * 2 * 2 * (3 if response != "tyre_load" else 1)


def test_scatter_is_told_from_noise() -> None:
    mean, _ = several()
    figures = {f.entry.id: f for f in car_figures(mean)}
    toe, camber = figures["vertical.bump_steer"], figures["vertical.camber_change"]
    true = abs(toe.values[1]) * np.std(TOE, ddof=1)
    assert toe.scatter_sd == pytest.approx(true, abs=2.0 * toe.noise_sd)
    assert toe.scatter_low > 3.0 * toe.noise_sd
    assert toe.scatter_low < true < toe.scatter_high
    assert camber.scatter_sd < 2.0 * camber.noise_sd and camber.scatter_low == 0.0
    estimate = mean.characteristics["vertical.bump_steer"]
    assert (estimate.value, estimate.sd) == (toe.mean, toe.mean_sd)
    assert estimate.sd == pytest.approx(np.hypot(toe.noise_of_mean, toe.scatter_sd / np.sqrt(3)))
    ends = mean.curve_sd("vertical")["toe"][:, -1] / mean.noise["vertical"]["toe"].point_sd(0)[-1]
    assert (ends > 3.0).all(), "scatter counts in the band of a curve"


def test_the_interval_of_a_scatter_holds_it_as_often_as_it_says() -> None:
    rng, entry = np.random.default_rng(3), CHARACTERISTICS["vertical.bump_steer"]
    held, variances = 0, []
    for _ in range(600):
        figures = figures_of(entry, rng.normal(2.0, np.hypot(0.5, 0.2), 4), 0.2)
        held += figures.scatter_low <= 0.5 <= figures.scatter_high
        variances.append(np.var(figures.values, ddof=1) - 0.2**2)
    assert 0.92 < held / 600 < 0.975
    assert np.mean(variances) == pytest.approx(0.25, rel=0.1)
    assert scatter_sd(np.full((3, 2), 1.0), 0.1) == pytest.approx([0.0, 0.0])


def test_the_chance_of_a_right_model_is_uniform() -> None:
    rng, entry = np.random.default_rng(4), CHARACTERISTICS["vertical.bump_steer"]
    chances = [figures_of(entry, rng.normal(2.0, 0.5, 3), 0.01).chance(2.0) for _ in range(600)]
    assert np.mean(np.array(chances) < 0.1) == pytest.approx(0.1, abs=0.035)


def test_one_car_is_reduced_as_ever(tmp_path: Path) -> None:
    (folder,) = cars(tmp_path, (1.0,), ("brake",))
    one, same = reduce_measurement(folder), reduce_cars([folder])
    assert not same.cars and car_figures(same) == ()
    assert repr(same.characteristics) == repr(one.characteristics)


def test_curves_are_compared_where_all_cars_were_measured(tmp_path: Path) -> None:
    folders = cars(tmp_path, (1.0, 1.0), ("vertical",))
    for path in folders[1].glob("*.csv"):
        table = pd.read_csv(path)
        table[table["pad_z [mm]"].abs() <= 60.0].to_csv(path, index=False)
    mean = reduce_cars(folders)
    assert np.abs(mean.curves.cases["vertical"].input).max() == 60.0
    assert {car.curves.cases["vertical"].input.size for car in mean.cars} == {
        mean.curves.cases["vertical"].input.size
    }


def _edit(folder: Path, old: str, new: str) -> None:
    path = folder / "test.toml"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def _without(folder: Path, *columns: str) -> None:
    for path in folder.glob("*.csv"):
        pd.read_csv(path).drop(columns=list(columns)).to_csv(path, index=False)


def _one_branch(folder: Path) -> None:
    for path in folder.glob("*.csv"):
        table = pd.read_csv(path)
        table.iloc[: len(table) // 2].to_csv(path, index=False)


RIGHT = ("toe_R [deg]", "camber_R [deg]", "caster_R [deg]", "wc_x_R [mm]", "wc_y_R [mm]", "wc_z_R [mm]",
         "tyre_load_R [N]")  # fmt: skip


def _one_wheel(folder: Path) -> None:
    _without(folder, *RIGHT)
    _edit(folder, "[records]", '[channels]\npreset = "doe_kc"\nabsent = ["R"]\n[records]')


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda f: _edit(f, "brake = ", "drive = "), r"\[records\] holds drive, that of .* brake"),
        (lambda f: _edit(f, "[alignment]", '[state]\narb = "off"\n[alignment]'), "anti-roll bar was off"),
        (
            lambda f: _edit(f, "[alignment]", "[setup]\nrack_mm_per_rev = 50.0\n[alignment]"),
            "rack_mm_per_rev",
        ),
        (lambda f: _edit(f, ", caster_deg = 4.2", ""), r"\[alignment\] holds left.toe_deg, left.camber_deg"),
        (_one_branch, "one branch only"),
        (_one_wheel, "holds no .*both wheels"),
        (
            lambda f: (
                _without(f, "caster_L [deg]", "caster_R [deg]"),
                _edit(f, "[records]", '[channels]\npreset = "doe_kc"\nabsent = ["caster"]\n[records]'),
            ),
            "does not have the channels",
        ),
    ],
)
def test_cars_of_different_tests_have_no_mean(
    tmp_path: Path, spoil: Callable[[Path], object], words: str
) -> None:
    folders = cars(tmp_path, (1.0, 1.0), ("brake",), runs=1)
    spoil(folders[1])
    with pytest.raises(InputError, match=words):
        reduce_cars(folders)


def test_a_car_is_named_once(tmp_path: Path) -> None:
    folders = cars(tmp_path, (1.0, 1.0), ("brake",))
    with pytest.raises(InputError, match="named twice"):
        reduce_cars([folders[0], folders[0] / "test.toml"])
    for path in folders[0].glob("*.csv"):
        (folders[1] / path.name).write_bytes(path.read_bytes())
    with pytest.raises(InputError, match="holds the same samples as"):
        reduce_cars(folders)
