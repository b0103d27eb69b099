"""Rig records and comparisons of the Python API."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import doe_kc as kc
from tests.api.cases import MEASURED, measured_car
from tests.cli.runner import succeeds


@pytest.fixture(scope="module")
def reduction(folder: Path) -> kc.ReductionResult:
    return kc.reduce(str(folder))


def test_it_writes_what_the_command_writes(
    reduction: kc.ReductionResult, folder: Path, tmp_path: Path
) -> None:
    written = reduction.write(tmp_path / "api")
    succeeds("reduce", folder, "--out", tmp_path / "command")
    tables = {f"{name}.csv" for name in ("curves", "characteristics", "gradients", "noise")}
    assert tables < {path.name for path in written} and len(written) == 8
    for path in written:
        assert path.read_bytes() == (tmp_path / "command" / path.relative_to(tmp_path / "api")).read_bytes()


def test_its_frames(reduction: kc.ReductionResult) -> None:
    measured = reduction.to_frame()["value"].dropna()
    truth = kc.simulate(measured_car(), MEASURED).characteristics["value"]
    spread = reduction.characteristics.loc[measured.index, "sd"]
    assert len(measured) == 9
    assert ((measured - truth[measured.index]).abs() < 5.0 * spread + 0.002 * truth.abs().max()).all()
    assert set(reduction.curves["load_case"]) == set(reduction.noise["load_case"]) == {*MEASURED}
    assert set(reduction.gradients["side"]) >= {"L", "R"}
    assert reduction.ride_height is None
    assert (
        repr(reduction) == "ReductionResult: car, 9 characteristics\n  load cases: lateral, lateral_opposite"
    )
    camber = reduction.reduced.measurement.curves.cases["lateral"].mean["camber"]
    np.testing.assert_array_equal(reduction.plot(response="camber").get_lines()[1].get_ydata(), camber[1])
    with pytest.raises(kc.InputError, match="there are toe"):
        reduction.plot("lateral", "castor")


def test_a_study_without_measurement(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(f"axle = {str(folder / 'axle.toml')!r}\n")
    for function in (kc.reduce, kc.compare, kc.discover, kc.run):
        with pytest.raises(kc.InputError, match="names no measurement"):
            function(tmp_path)


def test_the_comparison_of_the_right_axle(folder: Path) -> None:
    nominal, right = kc.compare(folder), kc.compare(folder, measured_car())
    assert list(nominal.to_frame().query("not inside").index) == [
        f"{case}.camber_change" for case in MEASURED
    ]
    assert right.characteristics["inside"].all()
    camber = [c.curves.query("response == 'camber'")["rms"].max() for c in (nominal, right)]
    assert camber[1] < 0.02 * camber[0]
    assert "7 of 9 characteristics inside" in repr(nominal)


def test_the_pictures_of_a_comparison(folder: Path) -> None:
    comparison = kc.compare(folder)
    (points,) = [line for line in comparison.plot().get_lines() if line.get_label() == "model"]
    inside = np.abs(points.get_xdata()) <= 1.0
    np.testing.assert_array_equal(inside, comparison.characteristics["inside"])
    assert len(comparison.plot_curves("lateral", "camber").get_lines()) == 4
