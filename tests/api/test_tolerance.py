"""Tolerance of the Python API."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import doe_kc as kc


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("tolerance")


@pytest.fixture(scope="module")
def result(folder: Path, out: Path) -> kc.ToleranceResult:
    return kc.tolerance(folder, 40, workers=1, out=out)


def test_its_frames(result: kc.ToleranceResult) -> None:
    frame = result.to_frame()
    cars = result.cars
    assert len(cars) == 40 and frame.index.name == "name"
    np.testing.assert_allclose(frame["sd"], [cars[name].std() for name in frame.index])
    assert frame.loc["lateral.toe_change", "measured_car"] != 0.0
    first, total = result.contributions("first_order"), result.contributions()
    np.testing.assert_allclose(first.sum(), 1.0)
    assert list(first.index) == list(result.scatter.index) == list(total.index)
    assert set(result.tightening.index) == set(first.index)
    assert {"load_case", "width", "inside_car"} <= set(result.bands)
    with pytest.raises(kc.InputError, match="expected first_order or total"):
        result.contributions("second")  # type: ignore[arg-type]


def test_the_requirements_are_the_intervals_of_the_targets(result: kc.ToleranceResult, folder: Path) -> None:
    frame = result.to_frame()
    targets = kc.compare(folder).characteristics
    for name in ("lateral.toe_change", "static.camber"):
        np.testing.assert_allclose(
            frame.loc[name, ["low", "high"]].astype(float), targets.loc[name, ["low", "high"]].astype(float)
        )
    assert np.isnan(frame.loc["vertical.bump_steer", "low"])  # no record


def test_what_it_writes_and_says(result: kc.ToleranceResult, folder: Path, out: Path) -> None:
    table = pd.read_csv(out / "tolerance" / "characteristics.csv", index_col="name")
    np.testing.assert_allclose(table["sd"], result.to_frame()["sd"], rtol=1e-8)
    assert "40 cars" in repr(result) and len(result.plot("static.toe").patches) > 5
    steps: list[tuple[str, int, int]] = []
    again = kc.tolerance(folder, 40, workers=1, out=out, progress=lambda *step: steps.append(step))
    assert again.tolerance.runs == 0 and steps[-1] == ("tolerance", 41, 41)
    pd.testing.assert_frame_equal(again.to_frame(), result.to_frame())
    with pytest.raises(kc.InputError, match="not among the characteristics"):
        result.plot("static.tow")
    with pytest.raises(kc.InputError, match="samples = 5, expected 30 or more"):
        kc.tolerance(folder, 5)
