"""Simulations and sensitivities of the Python API."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot

import doe_kc as kc
from doe_kc.characteristics import reduce_all
from tests.cli.runner import succeeds
from tests.reference import EXAMPLE

AXLE = EXAMPLE / "axle.toml"
CASES = ["vertical", "lateral"]


@pytest.fixture(scope="module")
def result() -> kc.SimulationResult:
    return kc.simulate(AXLE, CASES)


def test_it_writes_what_the_command_writes(result: kc.SimulationResult, tmp_path: Path) -> None:
    written = result.write(str(tmp_path / "api"))
    options = [option for case in CASES for option in ("--case", case)]
    succeeds("simulate", AXLE, *options, "--out", tmp_path / "command")
    assert [p.name for p in written] == ["curves.csv", "characteristics.csv"]
    for path in written:
        assert path.read_bytes() == (tmp_path / "command" / path.name).read_bytes()


def test_its_frames(result: kc.SimulationResult) -> None:
    assert set(result.curves["load_case"]) == {*CASES}
    values = reduce_all(result.curve_set)
    assert result.to_frame() is result.characteristics
    for name, row in result.characteristics.iterrows():
        assert row["value"] == values[str(name)]
    assert result.characteristics.loc["vertical.bump_steer", "unit"] == "deg/m"


def test_the_technique_of_the_roll() -> None:
    by_pads = kc.simulate(AXLE, ["roll"], roll="counter_phase")
    assert set(by_pads.curves["input_unit"]) == {"mm"}
    with pytest.raises(kc.InputError, match="roll sideways: expected body or counter_phase"):
        kc.simulate(AXLE, roll="sideways")


def test_an_unknown_load_case() -> None:
    with pytest.raises(kc.InputError, match='Did you mean "vertical"'):
        kc.simulate(AXLE, ["vertikal"])


def test_an_unlikely_axle_is_solved_with_a_warning(caplog: pytest.LogCaptureFixture) -> None:
    kc.simulate(kc.with_values(AXLE, {"spring.rate": 500.0}), ["vertical"])
    assert any("spring" in record.message for record in caplog.records)


def test_its_picture(result: kc.SimulationResult) -> None:
    axes = result.plot("lateral", "camber")
    left, right = axes.get_lines()
    curves = result.curve_set.cases["lateral"]
    np.testing.assert_array_equal(left.get_ydata(), curves.mean["camber"][0])
    np.testing.assert_array_equal(right.get_ydata(), curves.mean["camber"][1])
    assert "[deg]" in axes.get_ylabel() and "[N]" in axes.get_xlabel()
    own = pyplot.figure().subplots()
    assert result.plot(ax=own) is own and own.get_lines()
    for names in (("roll", "toe"), ("lateral", "tow")):
        with pytest.raises(kc.InputError, match="there are"):
            result.plot(*names)


def test_it_is_short_in_words_and_html(result: kc.SimulationResult) -> None:
    assert repr(result).startswith("SimulationResult: Front axle, McPherson, ")
    assert len(repr(result).splitlines()) == 3 and len(repr(result)) < 300
    html = result._repr_html_()
    assert html.count("<table") == 1 and "vertical.bump_steer" in html and len(html) < 10_000


def test_sensitivities_are_the_differences_of_simulations() -> None:
    slopes = kc.sensitivities(AXLE, ["ROB.z", "llr.F?", "spring.rate"], ["vertical.bump_steer", "static.toe"])
    frame = slopes.to_frame()
    assert list(frame.index) == ["ROB.z", "llr.Fx", "llr.Fy", "llr.Fz", "spring.rate"]
    nominal = kc.parameters(AXLE)["nominal"]
    for path, step in (("ROB.z", 1e-2), ("llr.Fx", 1e-3)):
        ends = [
            kc.simulate(
                kc.with_values(AXLE, {path: nominal[path] + sign * step}), ["vertical"]
            ).characteristics
            for sign in (-1, 1)
        ]
        difference = (ends[1]["value"] - ends[0]["value"])["vertical.bump_steer"] / (2.0 * step)
        assert frame.loc[path, "vertical.bump_steer"] == pytest.approx(difference, rel=1e-4)
    assert slopes.units.loc["ROB.z", "vertical.bump_steer"] == "deg/m per mm"
    assert slopes.units.loc["llr.Fx", "static.toe"] == "deg per 1"


def test_sensitivities_as_rows(tmp_path: Path) -> None:
    slopes = kc.sensitivities(AXLE, ["ROB.?"], ["vertical.bump_steer", "vertical.camber_change"])
    tidy = slopes.to_frame("tidy")
    pivoted = tidy.pivot(index="parameter", columns="characteristic", values="value")
    pd.testing.assert_frame_equal(
        pivoted[slopes.to_frame().columns], slopes.to_frame(), check_names=False, check_column_type=False
    )
    (path,) = slopes.write(tmp_path)
    assert list(pd.read_csv(path).columns) == ["parameter", "characteristic", "value", "unit"]
    axes = slopes.plot("vertical.camber_change")
    widths = sorted(abs(bar.get_width()) for bar in axes.patches)
    np.testing.assert_allclose(widths, sorted(slopes.to_frame()["vertical.camber_change"].abs()))
    for call in (lambda: slopes.to_frame("wide"), lambda: slopes.plot("vertical.toe")):  # type: ignore[arg-type]
        with pytest.raises(kc.InputError):
            call()


def test_sensitivities_of_unknown_names() -> None:
    with pytest.raises(kc.InputError, match=r"'LFF\.z' matches no parameter"):
        kc.sensitivities(AXLE, ["LFF.z"])
    with pytest.raises(kc.InputError, match=r'Did you mean "vertical\.bump_steer"'):
        kc.sensitivities(AXLE, ["ROB.z"], ["vertical.bumpsteer"])
