"""The store as tables."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from doe_kc.axle import design_parameters
from doe_kc.campaign import export
from doe_kc.campaign.export import Format, designs_frame, evaluations_frame, export_store
from doe_kc.campaign.runner import Campaign
from doe_kc.campaign.store import Store, open_store
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.characteristics.result_columns import CHARACTERISTIC_RESULTS, RESULT_COLUMNS
from doe_kc.ground.errors import InputError
from tests.campaign.toys import Toy, bump_steer, designs, toy_curves
from tests.reference import nominal

PARQUET = pytest.param(
    "parquet",
    marks=pytest.mark.skipif(
        importlib.util.find_spec("pyarrow") is None, reason="the extra parquet is not in"
    ),
)


def read(path: Path) -> pd.DataFrame:
    return pd.read_parquet(path) if path.suffix == ".parquet" else pd.read_csv(path)


@pytest.fixture
def store(toy: Toy) -> Iterator[Store]:
    """Three designs, the second one failed."""
    solver = replace(toy, fails=(2.0,))
    with open_store(None, solver) as store, Campaign(solver, store, workers=1) as campaign:
        campaign.evaluate(designs(2), "sample:lhs")
        campaign.evaluate(designs(3), "correlate:ego")
        yield store


@pytest.mark.parametrize("form", ["csv", PARQUET])
def test_one_row_a_design_and_the_curves_beside(store: Store, tmp_path: Path, form: Format) -> None:
    table, curves = (read(p) for p in export_store(store, tmp_path, form))
    assert list(table["x"]) == [1.0, 2.0, 3.0]
    assert list(table["status"]) == ["ok", "failed", "ok"]
    assert list(table["origin"]) == ["sample:lhs", "sample:lhs", "correlate:ego"]
    assert table["reason"].fillna("").tolist() == ["", "no equilibrium at x = 2", ""]
    assert np.isfinite(table["vertical.bump_steer"]).tolist() == [True, False, True]
    assert set(curves["key"]) == set(table["key"][[0, 2]])
    third = curves[(curves["key"] == table["key"][2]) & (curves["side"] == "R")]
    case = toy_curves(3.0).cases["vertical"]
    np.testing.assert_allclose(third["input"], case.input)
    np.testing.assert_allclose(third["toe"], case.mean["toe"][1], rtol=1e-9)
    np.testing.assert_allclose(third["toe_half_width"], case.half_width["toe"][1], rtol=1e-9)


@pytest.mark.parametrize("form", ["csv", PARQUET])
def test_an_empty_store(toy: Toy, tmp_path: Path, form: Format) -> None:
    with open_store(None, toy) as empty:
        written = export_store(empty, tmp_path, form)
    assert all(p.exists() for p in written)


def test_windows_and_origins_are_chosen(store: Store) -> None:
    narrow, wide = (evaluations_frame(store, {"vertical": w}) for w in (5.0, 80.0))
    assert wide["vertical.bump_steer"][0] > 1.2 * narrow["vertical.bump_steer"][0]
    assert len(evaluations_frame(store, {}, "correlate:*")) == 1


def test_no_column_is_there_twice() -> None:
    """static.toe is a parameter and a characteristic."""
    parameters = {p.path for p in design_parameters(nominal())}
    assert not parameters & RESULT_COLUMNS
    assert len(set(CHARACTERISTIC_RESULTS)) == len(CHARACTERISTICS)
    assert {"result.static.toe", "vertical.bump_steer"} <= RESULT_COLUMNS


def test_every_column_but_the_parameters_is_known_as_a_result(toy: Toy) -> None:
    with Campaign(toy, workers=1) as campaign:
        frame = designs_frame([{"x": 1.0}], campaign.evaluate(designs(1), "test"))
    assert set(frame.columns) == {"x", *RESULT_COLUMNS}


def test_a_design_may_name_a_parameter_that_another_does_not(toy: Toy) -> None:
    with Campaign(toy, workers=1) as campaign:
        found = campaign.evaluate(designs(2), "test")
        frame = designs_frame([{"x": 1.0}, {"x": 2.0, "y": 5.0}], found)
    assert np.isnan(frame["y"][0]) and list(frame["vertical.bump_steer"]) == bump_steer(found)


def test_parquet_without_its_package(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(export.importlib.util, "find_spec", lambda _name: None)
    with pytest.raises(InputError, match=r"needs the extra `parquet`; install doe-kc\[parquet\]"):
        export.write_table(tmp_path / "t.parquet", pd.DataFrame({"a": [1]}))
    with pytest.raises(InputError, match="--export xlsx: expected csv or parquet"):
        export.require_format("xlsx")
    assert export.require_format("csv") == "csv" and not list(tmp_path.iterdir())
