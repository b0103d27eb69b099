"""A study of several measured cars: what is checked, written and said."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import doe_kc as kc
from doe_kc.ground.errors import InputError
from doe_kc.reports.correlation.workbook import car_table
from doe_kc.workflow.measure import study_records
from tests.cli.runner import fails, succeeds, write_study

TOE = "brake.brake_steer"


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Two cars, the second with 1.6 times the toe and noise of its own."""
    folder = write_study(tmp_path / "s", records={"brake": ["brake.csv"]}, extra='pictures = "none"')
    shutil.copytree(folder / "rig", folder / "rig_2")
    table, rng = pd.read_csv(folder / "rig_2" / "brake.csv"), np.random.default_rng(1)
    for name in [c for c in table if c.startswith(("toe", "camber"))]:
        noise = 0.003 * rng.standard_normal(len(table))
        table[name] = (1.6 if name.startswith("toe") else 1.0) * table[name] + noise
    table.to_csv(folder / "rig_2" / "brake.csv", index=False)
    file = folder / "study.toml"
    text = file.read_text("utf-8")
    assert 'measurement = "rig"' in text
    file.write_text(text.replace('measurement = "rig"', 'measurement = ["rig", "rig_2"]'), "utf-8")
    return folder


def test_reduce_and_compare_say_how_the_cars_scatter(study: Path) -> None:
    assert "mean of 2 cars" in succeeds("check", study).out
    file = study / "r.json"
    succeeds("reduce", study, "--json", file)
    document = json.loads(file.read_text("utf-8"))
    record = document["cars"][TOE]
    assert record["car_2"] == pytest.approx(1.6 * record["car_1"], rel=0.05)
    assert record["mean"] == pytest.approx((record["car_1"] + record["car_2"]) / 2.0)
    assert record["mean"] == document["characteristics"][TOE]["value"]
    assert record["mean_sd"] == document["characteristics"][TOE]["sd"]
    assert record["scatter_sd"] > 3.0 * record["noise_sd"] > 0.0
    for folder in ("reduce", "compare"):
        table = pd.read_csv(study / "out" / folder / "cars.csv", index_col="name")
        assert table.loc[TOE, "standard_errors"] == pytest.approx(
            (table.loc[TOE, "model"] - table.loc[TOE, "mean"]) / table.loc[TOE, "mean_sd"]
        )
        assert ">Cars<" in (study / "out" / folder / "report.html").read_text("utf-8")


def test_correlate_aims_at_the_mean_and_hands_the_scatter_on(study: Path) -> None:
    with (study / "study.toml").open("a", encoding="utf-8") as file:
        file.write('[variables]\nuse = ["llr.Fx"]\n[correlation]\nmethod = "gauss_newton"\n')
    result = kc.correlate(study)
    target = next(t for t in result.correlation.problem.targets.characteristics if t.entry.id == TOE)
    reduced = study_records(kc.read_study(study))
    assert reduced is not None
    figures = next(c.figures for c in reduced.cars if c.entry.id == TOE)
    assert (target.value, target.sd) == (figures.mean, figures.mean_sd)
    written = {p.name: p for p in result.write(study / "out")}
    assert "cars.csv" in written
    sheet = pd.read_excel(written["correlation.xlsx"], sheet_name="Cars", header=None)
    assert "Scatter sd, one car" in sheet.to_numpy().ravel()


def test_a_single_car_has_no_table_of_cars(study: Path) -> None:
    one = kc.reduce(kc.read_study(study, measurement=study / "rig")).reduced
    assert one.cars == () and not one.measurement.cars
    both = kc.reduce(kc.read_study(study, measurement=[study / "rig", str(study / "rig_2")])).reduced
    table = car_table(both.cars)
    assert [c.key for c in table.columns][-2:] == ["car_1", "car_2"]


def test_cars_of_different_tests_are_refused(study: Path) -> None:
    manifest = study / "rig_2" / "test.toml"
    manifest.write_text(manifest.read_text("utf-8") + '\n[state]\narb = "off"\n', "utf-8")
    fails(2, "the anti-roll bar was off", "check", study)
    fails(2, "leave one of them out", "reduce", study)
    with pytest.raises(InputError, match="rig_2"):
        kc.reduce(study)
    again = ("--measurement", study / "rig", "--measurement", study / "rig")
    fails(2, "is named twice", "reduce", study, *again)
