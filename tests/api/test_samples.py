"""Samples of the Python API."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import doe_kc as kc
from doe_kc.true_solver.outcome import Outcome


@pytest.fixture(scope="module")
def result(folder: Path) -> kc.SamplingResult:
    return kc.sample(folder, 12, workers=1)


def test_designs_and_responses(result: kc.SamplingResult) -> None:
    frame = result.to_frame()
    assert len(frame) == 12 and (frame["status"] == "ok").all()
    assert list(result.designs.columns) == list(result.space.paths)
    pd.testing.assert_frame_equal(result.designs, frame[list(result.space.paths)], check_names=False)
    np.testing.assert_array_equal(result.responses["static.toe"], frame["result.static.toe"])
    row = result.designs.loc[3].to_dict()
    again = kc.simulate(kc.with_values(result.study.axle, row)).characteristics["value"]
    np.testing.assert_allclose(result.responses.loc[3, again.index], again, rtol=1e-9)


def test_extend_runs_only_what_completes_the_designs(folder: Path, tmp_path: Path) -> None:
    first = kc.sample(folder, 3, out=tmp_path, workers=1)
    more = kc.sample(folder, 5, out=tmp_path, extend=True, workers=1)
    assert (more.sampled.runs, more.sampled.kept) == (2, 3)
    np.testing.assert_allclose(more.designs.iloc[:3], first.designs, rtol=1e-9)
    with pytest.raises(kc.InputError, match="holds 5 designs"):
        kc.sample(folder, 4, out=tmp_path, extend=True, workers=1)
    with pytest.raises(kc.InputError, match="without a store"):
        kc.sample(folder, 4, extend=True, workers=1)


def test_nothing_is_written_unless_asked(result: kc.SamplingResult, folder: Path, tmp_path: Path) -> None:
    assert result.sampled.runs == 12 and not (folder / "out").exists()
    first = kc.sample(folder, 3, out=tmp_path, workers=1)
    again = kc.sample(folder, 3, out=str(tmp_path), workers=1)
    assert (first.sampled.runs, again.sampled.runs) == (3, 0)
    assert {p.name for p in tmp_path.iterdir()} == {"store", "sample"}
    table = pd.read_csv(tmp_path / "sample" / "designs.csv")
    np.testing.assert_allclose(table[list(first.space.paths)], first.designs, rtol=1e-9)
    assert not (folder / "out").exists()


def test_designs_that_fail_stay_in_the_frame_alone(result: kc.SamplingResult) -> None:
    first, *others = result.sampled.outcomes
    failed = Outcome(None, np.full_like(first.characteristics, np.nan), "no equilibrium: steer", 0.0)
    partial = replace(result, sampled=replace(result.sampled, outcomes=(first, failed, *others[1:])))
    assert list(partial.to_frame()["status"][:3]) == ["ok", "failed", "ok"]
    assert list(partial.designs.index) == list(partial.responses.index) == [0, *range(2, 12)]
    pd.testing.assert_frame_equal(partial.designs, result.designs.drop(index=1))
    assert "1 failed" in repr(partial) and "1 x no equilibrium: steer" in repr(partial)


def test_its_picture(result: kc.SamplingResult) -> None:
    (points,) = result.plot("ROB.z", "vertical.bump_steer").get_lines()
    np.testing.assert_array_equal(points.get_xdata(), result.designs["ROB.z"])
    for names in (("ROB.zz", "vertical.bump_steer"), ("ROB.z", "vertical.bump")):
        with pytest.raises(kc.InputError, match="Did you mean"):
            result.plot(*names)


def test_bad_numbers(folder: Path) -> None:
    with pytest.raises(kc.InputError, match="expected 1 or more"):
        kc.sample(folder, 0)
    with pytest.raises(kc.InputError, match="lhz"):
        kc.sample(folder, 3, method="lhz")
