from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.characteristics import reduce_all
from doe_kc.curves import RIG_RESPONSES, CaseCurves, CurveSet
from doe_kc.measurement import read_record
from doe_kc.measurement.branches import case_curves, input_grid, reduce_case
from tests.measurement.synthetic import (
    RESOLUTION,
    csv_text,
    record_columns,
    truth,
)


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
