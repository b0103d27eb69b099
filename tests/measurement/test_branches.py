from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from doe_kc.characteristics import reduce_all
from doe_kc.curves import RIG_RESPONSES, CaseCurves, CurveSet
from doe_kc.ground.errors import InputError
from doe_kc.measurement import read_record
from doe_kc.measurement.branches import case_curves, input_grid, local_weights, reduce_case, split_loop
from tests.measurement.synthetic import (
    RESOLUTION,
    csv_text,
    record_columns,
    triangle,
    truth,
)


def sine(samples: int) -> np.ndarray:
    return np.cos(2.0 * np.pi * np.arange(samples) / samples)


def test_the_standard_loop_splits_in_half() -> None:
    loop = split_loop(triangle(), label="f")
    assert loop.unload[0] == 0 and loop.unload[-1] == 256
    assert loop.load[0] == 256 and loop.load[-1] == 0  # closed by its first sample
    assert loop.load.size == 257


@settings(max_examples=60, deadline=None)
@given(
    st.integers(64, 700),
    st.floats(0.0, 1.0),
    st.floats(0.0, 0.004),
    st.booleans(),
    st.integers(0, 2**31),
)
def test_any_phase_shape_and_noise_gives_two_whole_branches(
    samples: int, phase: float, noise: float, smooth: bool, seed: int
) -> None:
    shape = sine(samples) if smooth else triangle(samples)
    rng = np.random.default_rng(seed)
    values = np.roll(shape, int(phase * samples)) + noise * rng.normal(size=samples)
    loop = split_loop(values, label="f")
    for branch, way in ((loop.unload, -1.0), (loop.load, 1.0)):
        assert way * (values[branch[-1]] - values[branch[0]]) > 1.8
        assert branch.size >= 0.45 * samples


def test_of_several_cycles_the_last_full_one_counts() -> None:
    values = np.concatenate([np.tile(triangle(200), 3), triangle(200)[:60]])
    loop = split_loop(values, label="f")
    assert min(loop.unload.min(), loop.load.min()) >= 300
    assert max(loop.unload.max(), loop.load.max()) <= 600


def test_a_run_in_from_zero_is_left_out() -> None:
    values = np.concatenate([np.linspace(0.0, 1.0, 60, endpoint=False), triangle(200), [1.0]])
    loop = split_loop(values, label="f")
    assert loop.unload[0] == 60 and loop.load[-1] == 260


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (np.linspace(-1.0, 1.0, 200), "no loop"),
        (np.concatenate([np.linspace(0, 1, 100), np.linspace(0, -1, 100)]), "no loop|turns back"),
        (triangle(400)[:300], "no loop"),
    ],
)
def test_what_is_no_loop_is_refused(values: np.ndarray, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        split_loop(values, label="file.csv")
    assert str(caught.value).startswith("file.csv: ")


def test_a_reversal_is_refused_with_its_sample() -> None:
    values = triangle(400)
    values[100:130] = values[100] + np.linspace(0.0, 0.4, 30)
    with pytest.raises(InputError, match=r"turns back at sample \d+"):
        split_loop(values, label="f")


def test_a_noisy_input_is_not_monotone() -> None:
    values = triangle(512) + 0.04 * np.random.default_rng(1).normal(size=512)
    with pytest.raises(InputError, match=r"not monotone|turns back"):
        split_loop(values, label="f")


GRID = np.linspace(-1.0, 1.0, 21)


@settings(max_examples=40, deadline=None)
@given(st.integers(8, 300), st.integers(0, 2**31), st.floats(0.01, 0.5))
def test_quadratics_are_reproduced_from_any_samples(count: int, seed: int, width: float) -> None:
    rng = np.random.default_rng(seed)
    x = np.sort(rng.uniform(-1.0, 1.0, count)) + np.linspace(0.0, 1e-3, count)
    a, b, c = rng.normal(size=3)
    y = a + b * x + c * x**2
    inner = GRID[np.abs(GRID - (x.min() + x.max()) / 2.0) < np.ptp(x) / 2.0]
    fitted = local_weights(x, inner, width) @ y
    np.testing.assert_allclose(fitted, a + b * inner + c * inner**2, atol=1e-5)


def test_noise_is_averaged_and_the_gram_predicts_by_how_much() -> None:
    rng = np.random.default_rng(3)
    x = np.linspace(-1.0, 1.0, 257)
    weights = local_weights(x, GRID, 0.15)
    noise = rng.normal(size=(257, 4000))
    np.testing.assert_allclose((weights @ noise).var(axis=1), np.diag(weights @ weights.T), rtol=0.12)
    assert np.diag(weights @ weights.T)[10] < 0.08


def reduced(folder: Path, load_case: str, **how: float) -> CaseCurves:
    path = folder / "a.csv"
    path.write_text(csv_text(record_columns(load_case, **how)))  # type: ignore[arg-type]
    return case_curves(load_case, reduce_case([read_record(path, load_case)]))


@pytest.mark.parametrize("load_case", ["vertical", "roll", "lateral", "brake"])
def test_a_noise_free_loop_gives_the_curve_back(tmp_path: Path, load_case: str) -> None:
    case = reduced(tmp_path, load_case)
    for response in RIG_RESPONSES:
        error = np.abs(case.mean[response] - truth(load_case, response)).max()
        # At the bump stop's kink the load is rounded by up to 1 N or so, and rides through the others.
        limit = {"tyre_load": 5.0}.get(response, RESOLUTION[response])
        assert error < limit, response
        assert np.abs(case.half_width[response]).max() < 1e-6 + 0.2 * RESOLUTION[response]


def test_gradients_beside_the_bump_stop_are_unbiased(tmp_path: Path) -> None:
    case = reduced(tmp_path, "vertical")
    exact = {r: truth("vertical", r) for r in RIG_RESPONSES}
    true_case = CaseCurves("vertical", "mm", case.input, exact, case.half_width)
    found, expected = (reduce_all(CurveSet("", {"vertical": c}, None, 790.0)) for c in (case, true_case))
    assert found["vertical.ride_rate"] == pytest.approx(expected["vertical.ride_rate"], rel=0.002)
    assert found["vertical.bump_steer"] == pytest.approx(expected["vertical.bump_steer"], rel=0.01)
    assert found["vertical.camber_change"] == pytest.approx(expected["vertical.camber_change"], rel=0.002)


def test_half_width_is_falling_minus_rising_over_two(tmp_path: Path) -> None:
    case = reduced(tmp_path, "lateral", half_width=3.0)
    for response in RIG_RESPONSES:
        expected = 3.0 * RESOLUTION[response] * (1.0 - (case.input / 2000.0) ** 4)
        np.testing.assert_allclose(
            case.half_width[response], np.stack([expected] * 2), atol=0.02 * RESOLUTION[response]
        )


def test_changes_are_zero_at_static_and_the_tyre_load_is_not(tmp_path: Path) -> None:
    case = reduced(tmp_path, "brake")
    middle = case.input.size // 2
    assert case.input[middle] == 0.0
    assert np.all(case.mean["toe"][:, middle] == 0.0)
    assert case.mean["tyre_load"][0, middle] == pytest.approx(4300.0, abs=1.0)


@pytest.mark.parametrize(("reach", "points"), [(1.02, 65), (0.992, 65), (0.9, 57), (0.5, 33)])
def test_a_smaller_rig_clips_the_grid(tmp_path: Path, reach: float, points: int) -> None:
    columns = record_columns("vertical")
    columns["pad_z [mm]"] = columns["pad_z [mm]"] * reach
    path = tmp_path / "a.csv"
    path.write_text(csv_text(columns))
    record = read_record(path, "vertical")
    grid = input_grid(record.case, [record])
    assert grid.size == points and 0.0 in grid


def test_the_loop_may_begin_anywhere(tmp_path: Path) -> None:
    plain = reduced(tmp_path, "vertical")
    columns = record_columns("vertical")
    rolled = {k: v if k == "time [s]" else np.roll(v, 150) for k, v in columns.items()}
    path = tmp_path / "b.csv"
    path.write_text(csv_text(rolled))
    other = case_curves("vertical", reduce_case([read_record(path, "vertical")]))
    for response in RIG_RESPONSES:
        np.testing.assert_allclose(
            other.mean[response], plain.mean[response], atol=0.1 * RESOLUTION[response]
        )
