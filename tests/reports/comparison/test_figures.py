"""Model against measurement: both wheels, noise, and the figures of both."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.measurement import Measurement, reduce_measurement
from doe_kc.reports.comparison.figures import NOISE_BAND, comparison_figure
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.targets.comparison import Comparison, compare

EXAMPLE = Path(__file__).parents[3] / "examples" / "front_axle"


@pytest.fixture(scope="module")
def measured() -> Measurement:
    return reduce_measurement(EXAMPLE / "rig")


@pytest.fixture(scope="module")
def comparison(measured: Measurement) -> Comparison:
    model = curve_set(solve(read_axle(EXAMPLE / "axle.toml"), ["lateral"]))
    noise = {"lateral": measured.curve_sd("lateral")}
    return compare(model, measured.curves, curve_sd=noise)


def test_the_noise_band_is_two_standard_deviations(comparison: Comparison, measured: Measurement) -> None:
    toe = comparison_figure(comparison, "lateral").panels[0]
    case, sd = measured.curves.cases["lateral"], measured.curve_sd("lateral")["toe"]
    assert sd.shape == (2, case.input.size) and (sd[0] > 0.0).any()
    for side, band in enumerate(toe.areas):
        upper = np.asarray(band.get_xy())[case.input.size : 2 * case.input.size, 1][::-1]  # type: ignore[union-attr]
        assert upper == pytest.approx(case.mean["toe"][side] + NOISE_BAND * sd[side])


def test_both_wheels_are_told_apart_without_colour(comparison: Comparison) -> None:
    toe = comparison_figure(comparison, "lateral").panels[0]
    model = [line for line in toe.lines if line.get_zorder() > 2]
    assert [line.get_linestyle() for line in model] == ["-", "--"]
    dots = [line for line in toe.lines if line.get_marker() == "o"]
    assert [dot.get_markerfacecolor() == "none" for dot in dots] == [False, True]


def test_the_table_has_both_wheels(comparison: Comparison) -> None:
    page = comparison_figure(comparison, "lateral")
    (table,) = [w.text for w in page.words if "RMS" in w.text]
    line = next(entry for entry in table.split("\n") if entry.startswith("tyre load"))
    rms = {c.side: c.rms for c in comparison.curves if (c.load_case, c.response) == ("lateral", "tyre_load")}
    assert [float(n) for n in line.split()[-2:]] == pytest.approx([rms["L"], rms["R"]], rel=0.01)
    assert page.outside == []
