"""The axle of an influence matrix by the Python API."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import doe_kc as kc
from tests.identification.cases import CAR, FREE, car_matrix
from tests.reference import EXAMPLE

AXLE = EXAMPLE / "axle.toml"
MASK = [("ROB.x", "lateral.toe_change"), ("*", "brake.wind_up")]


@pytest.fixture(scope="module")
def steps() -> list[tuple[str, int, int]]:
    return []


@pytest.fixture(scope="module")
def result(steps: list[tuple[str, int, int]]) -> kc.IdentificationResult:
    return kc.identify(
        car_matrix(), AXLE, FREE, MASK, starts=1, noise=1e-3, workers=1,
        progress=lambda *step: steps.append(step),
    )  # fmt: skip


def test_its_tables(result: kc.IdentificationResult) -> None:
    for path, value in CAR.items():
        assert result.parameters.loc[path, "identified"] == pytest.approx(value, rel=2e-3)
        assert kc.parameters(result.axle).loc[path, "nominal"] == pytest.approx(value, rel=2e-3)
    frame = result.to_frame()
    assert frame.index.tolist() == list(car_matrix().columns)
    fitted = frame[frame["fitted"]]
    assert fitted["signed"].min() > 0.999 and fitted["magnitude_before"].min() < 0.99
    assert frame.loc["brake.wind_up", "cells"] == 0 and not frame.loc["brake.wind_up", "fitted"]
    cell = result.cells.query("parameter == 'ROB.x' and characteristic == 'lateral.toe_change'")
    assert not cell["fitted"].item()
    assert cell["identified"].item() == pytest.approx(cell["measured"].item(), abs=0.3)
    assert result.directions["information"].is_monotonic_decreasing and len(result.starts) == 1


def test_its_words_and_progress(result: kc.IdentificationResult, steps: list[tuple[str, int, int]]) -> None:
    assert "12 parameters x 6 characteristics" in repr(result) and "mean correlation" in repr(result)
    assert "<table" in result._repr_html_()
    assert steps[-1][1] == steps[-1][2] and "start 1 of 1" in steps[-1][0]


def test_its_heat_maps(result: kc.IdentificationResult) -> None:
    axes = result.plot("measured")
    (mesh,) = [c for c in axes.collections if c.get_array() is not None]
    assert np.abs(np.ravel(mesh.get_array())).max() >= 100.0 - 1e-9
    assert [t.get_text() for t in axes.get_yticklabels()] == list(car_matrix().index)
    difference = result.plot()
    (mesh,) = [c for c in difference.collections if c.get_array() is not None]
    fitted = [k for k, c in enumerate(car_matrix()) if c != "brake.wind_up"]
    largest = np.abs(np.reshape(mesh.get_array(), car_matrix().shape)[:, fitted]).max()
    assert largest < 1.0 and f"at most {largest:.2g} percent" in difference.get_title()
    assert mesh.get_clim() == (-1.0, 1.0) and axes.collections[0].get_clim() == (-100.0, 100.0)
    with pytest.raises(kc.InputError, match="expected measured, identified, difference"):
        result.plot("both")  # type: ignore[arg-type]


def test_it_writes_an_axle_that_reads_the_same(result: kc.IdentificationResult, tmp_path: Path) -> None:
    written = {p.name for p in result.write(tmp_path)}
    assert written == {
        *("agreement.csv", "cells.csv", "parameters.csv", "directions.csv", "starts.csv"),
        *("axle.toml", "identification.png"),
    }
    assert kc.read_axle(tmp_path / "axle.toml").values == result.axle.values
    table = pd.read_csv(tmp_path / "agreement.csv", index_col="characteristic")
    np.testing.assert_allclose(table["signed"], result.to_frame()["signed"], rtol=1e-8)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"starts": 0}, "starts is 0, expected 1 or more"),
        ({"noise": 0.0}, "noise is 0.0, expected a share"),
        ({"free": ["LLG.*"]}, "matches no coordinate"),
    ],
)
def test_what_is_wrong(options: dict[str, object], words: str) -> None:
    with pytest.raises(kc.InputError, match=words):
        kc.identify(car_matrix(), AXLE, **options)  # type: ignore[arg-type]
