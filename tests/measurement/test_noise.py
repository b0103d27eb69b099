from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from doe_kc.measurement import Measurement, reduce_measurement
from doe_kc.measurement.noise import pooled_white_sd, white_sd
from doe_kc.measurement.noise_estimation import LIKELIHOOD_POINTS, error_components, thinned
from tests.measurement.synthetic import Errors, triangle, truth, write_rig


@pytest.mark.parametrize("sd", [0.001, 0.02, 3.0])
def test_white_noise_is_found_under_a_large_slow_signal(sd: float) -> None:
    rng = np.random.default_rng(1)
    signal = 1e3 * sd * np.cos(2.0 * triangle(512))
    runs = [signal + sd * rng.normal(size=(2, 512)) for _ in range(3)]
    assert pooled_white_sd(runs) == pytest.approx(sd, rel=0.06)


def test_a_clean_curve_has_none() -> None:
    assert white_sd(triangle(512)[None, :]) < 1e-12


def test_coarse_quantisation_still_shows() -> None:
    rng = np.random.default_rng(2)
    values = np.round(0.2 * rng.normal(size=(2, 512)))
    assert 0.0 < white_sd(values) < 0.3


def simulated(seed: int, curves: int = 60) -> list:
    """Three runs each of many curves with offset 2, gain 0.004, smooth 1.5 of length 0.3, white 0.2."""
    rng = np.random.default_rng(seed)
    x = np.linspace(-1.0, 1.0, 41)
    smooth = np.exp(-0.5 * ((x[:, None] - x[None, :]) / 0.3) ** 2) + 1e-9 * np.eye(41)
    root = np.linalg.cholesky(smooth)
    out = []
    for _ in range(curves):
        signal = rng.uniform(-500.0, 500.0) * x + 200.0 * x**2
        runs = np.stack(
            [
                signal * (1.0 + 0.004 * rng.normal())
                + 2.0 * rng.normal()
                + 1.5 * root @ rng.normal(size=41)
                + 0.2 * rng.normal(size=41)
                for _ in range(3)
            ]
        )
        out.append(thinned(x, 0.04 * np.eye(41), signal, runs))
    return out


def test_components_are_recovered_from_simulated_repeats() -> None:
    found = error_components(simulated(1), resolution=1.0)
    assert found.offset == pytest.approx(2.0, rel=0.3)
    assert found.gain == pytest.approx(0.004, rel=0.3)
    assert found.smooth == pytest.approx(1.5, rel=0.15)
    assert found.length == pytest.approx(0.3, rel=0.15)
    assert found.dof == 120 and found.source == "repeats"


def test_thinning_keeps_both_ends() -> None:
    x = np.linspace(-1.0, 1.0, 65)
    repeats = thinned(x, np.eye(65), x, np.zeros((3, 65)))
    assert repeats.relative.size == LIKELIHOOD_POINTS
    assert repeats.relative[0] == -1.0 and repeats.relative[-1] == 1.0


def test_one_run_takes_the_resolution_and_says_so(tmp_path: Path) -> None:
    measurement = reduce_measurement(write_rig(tmp_path, cases=("brake",), runs=1))
    model = measurement.noise["brake"]["wc_x"]
    assert model.components.source == "resolution" and model.components.dof == 0
    assert model.components.offset == 0.02 and model.loop == 0.0
    assert model.white == pytest.approx(0.02, rel=0.2)


def test_white_noise_of_the_rig_is_its_sensor_resolution(car_a: Measurement) -> None:
    for case in car_a.noise.values():
        for response, model in case.items():
            expected = {"tyre_load": 4.0}.get(response, 0.02 if response.startswith("wc") else 0.003)
            assert model.white == pytest.approx(expected, rel=0.12)


def test_covariance_is_symmetric_positive_and_pinned_at_static(car_a: Measurement) -> None:
    for response, model in car_a.noise["vertical"].items():
        matrix = model.covariance()
        np.testing.assert_allclose(matrix, matrix.T, rtol=1e-12, atol=1e-18)
        assert np.linalg.eigvalsh(matrix).min() > -1e-12 * np.trace(matrix)
        pinned = np.abs(matrix[model.input.size // 2]).max()
        assert (pinned > 1.0) if response == "tyre_load" else (pinned < 1e-15)
        assert np.linalg.eigvalsh(model.half_width_covariance()).min() > -1e-12


def test_covariance_scales_with_runs_and_maps_to_other_inputs(car_a: Measurement) -> None:
    model = car_a.noise["roll"]["camber"]
    np.testing.assert_allclose(model.covariance(runs=1), 3.0 * model.covariance())
    part = model.covariance(model.input[::4])
    np.testing.assert_allclose(part, model.covariance()[::4, ::4])
    assert dataclasses.replace(model, runs=6).covariance()[0, 0] < model.covariance()[0, 0]


def test_stated_errors_match_the_scatter_of_whole_tests(tmp_path: Path) -> None:
    """The mean curve's error over simulated tests has the stated variance."""
    chi2 = []
    for seed in range(6):
        folder = tmp_path / str(seed)
        folder.mkdir()
        m = reduce_measurement(
            write_rig(folder, cases=("vertical", "brake"), errors=Errors(1.0, 1.0, 0.002, 0.5), seed=seed)
        )
        for case in ("vertical", "brake"):
            for response in ("toe", "camber", "wc_x", "wc_y"):
                for side in (0, 1):
                    error = m.curves.cases[case].mean[response][side] - truth(case, response)[side]
                    variance = np.diag(m.noise[case][response].covariance(side=side))
                    used = variance > 0.0
                    chi2.append(np.mean(error[used] ** 2 / variance[used]))
    assert 0.6 < np.mean(chi2) < 1.6
