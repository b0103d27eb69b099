from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import matplotlib
import pytest

from doe_kc.curves import RESPONSE_UNITS, RIG_RESPONSES
from doe_kc.ground.errors import RunError
from doe_kc.ground.picture_format import PictureFormat
from doe_kc.measurement import Measurement
from doe_kc.reports.drawing.sheet import sheet
from doe_kc.reports.drawing.style import PALETTE, save
from doe_kc.reports.measurement.figures import rig_figure


def test_every_panel_has_its_unit(car_a: Measurement) -> None:
    fig = rig_figure(car_a, "vertical")
    panels = fig.panels
    assert len(panels) == 21
    for row, response in enumerate(RIG_RESPONSES):
        unit = RESPONSE_UNITS[response]
        assert panels[3 * row].y_label.text.endswith(f" [{unit}]")
        assert panels[3 * row + 2].y_label.text == f"residual [{unit}]"
    assert [panel.x_label.text for panel in panels[-3:]] == ["Pad travel [mm]"] * 3
    assert any("26.264 ± 0.045 N/mm" in t.text for t in panels[18].texts)
    assert fig.outside == []


def test_several_cars_are_drawn_each_and_minus_their_mean(car_a: Measurement) -> None:
    brake = replace(car_a, cars=(car_a, car_a, car_a), trends={})
    fig = rig_figure(brake, "brake")
    assert fig.panels[2].title.text == "Cars minus mean"
    assert fig.panels[2].y_label.text == "difference [deg]"
    assert len(fig.panels[2].lines) == 6 + 1 and fig.outside == []


@pytest.mark.parametrize(
    ("case", "panel", "ident", "travel"),
    [
        ("vertical", 3, "vertical.camber_change", "wheel"),
        ("roll", 0, "roll.roll_steer", "wheel"),
        ("roll", 18, "roll.roll_rate", "pad"),
    ],
)
def test_gradients_name_their_abscissa_and_are_those_of_the_tables(
    car_a: Measurement, case: str, panel: int, ident: str, travel: str
) -> None:
    (note,) = [t.text for t in rig_figure(car_a, case).panels[panel].texts]
    plain, tabled = note.split("\n")
    estimate = car_a.characteristics[ident]
    assert tabled.endswith(f" of {travel} travel")
    assert float(tabled.split()[0].replace("\N{MINUS SIGN}", "-")) == pytest.approx(
        estimate.value, abs=estimate.sd
    )
    assert plain.endswith("deg/m of pad travel" if case == "vertical" else "/deg")


def test_a_gradient_over_the_input_stands_once(car_a: Measurement) -> None:
    panels = rig_figure(car_a, "lateral").panels
    assert all("\n" not in t.text for panel in panels for t in panel.texts)


FORMATS: tuple[PictureFormat, ...] = ("png", "svg")


def test_a_figure_is_saved_twice_the_same(tmp_path: Path) -> None:
    before = dict(matplotlib.rcParams)
    contents = []
    for name in ("a.1", "b.1"):
        fig, panels = sheet(1, 2, size=(4.0, 2.0), margins={})
        panels[0, 0].plot([0.0, 1.0], [0.0, 1.0], color=PALETTE["blue"])
        png, svg = (save(fig, tmp_path / "new" / name, form) for form in FORMATS)
        assert (png.name, svg.name) == (f"{name}.png", f"{name}.svg")
        assert png.read_bytes().startswith(b"\x89PNG")
        contents.append((png.read_bytes(), svg.read_bytes()))
    assert contents[0] == contents[1]
    assert dict(matplotlib.rcParams) == before


def test_an_unwritable_folder_is_a_run_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    fig, _ = sheet(1, 1, margins={})
    with pytest.raises(RunError, match="file: folder cannot be made"):
        save(fig, tmp_path / "file" / "x")


def test_a_name_with_dollars_is_no_formula(car_a: Measurement, tmp_path: Path) -> None:
    named = replace(car_a, manifest=car_a.manifest.model_copy(update={"name": "Car $\\frac$"}))
    assert save(rig_figure(named, "lateral"), tmp_path / "x").stat().st_size > 10_000
