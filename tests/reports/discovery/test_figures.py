"""Pictures of a discovery: all written, everything labelled, nothing off its axis."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection

from doe_kc.ground.errors import RunError
from doe_kc.reports.discovery.curves import curve_figure, worst_views
from doe_kc.reports.discovery.evidence import evidence_figure, evidence_steps
from doe_kc.reports.discovery.figures import (
    discovery_figures,
    discovery_jobs,
    gain_words,
    held_out_figure,
)
from doe_kc.reports.discovery.gaps import gap_figure
from doe_kc.reports.discovery.heat_map import discovery_grids, heat_map_figure, signed
from doe_kc.reports.discovery.isolability import isolability
from doe_kc.reports.discovery.isolability_figure import isolability_figure
from doe_kc.reports.discovery.parameter_figure import PARAMETERS_SHOWN, moved_parameters, parameter_figure
from doe_kc.reports.discovery.parameters import tuned_parameters
from doe_kc.reports.discovery.tables import gap_rows
from doe_kc.reports.drawing.sheet import Sheet
from doe_kc.reports.drawing.style import A4
from doe_kc.reports.drawing.words import text_width
from tests.discovery.cases import LOAD_CASES, discovery

CARS = ["none", "named", "class", "unexplained", "lead", "two"]
NAMES = ["disagreement", "gap", "evidence", "worst_curves", "isolability", "parameters", "held_out"]


@pytest.mark.parametrize("car", CARS)
def test_every_verdict_is_drawn(car: str, tmp_path: Path) -> None:
    found = discovery(car)
    jobs = discovery_jobs(found, tmp_path, "S $x_1$")
    assert [path.name for path, _ in jobs] == (NAMES if found.held_out else NAMES[:-1])
    for _, make in jobs:
        page = make()
        assert isinstance(page, Sheet) and page.heading.endswith("S $x_1$")
        assert all(panel.lines or panel.areas for panel in page.panels)
        assert page.outside == []


def test_files_are_written(tmp_path: Path) -> None:
    drawing = discovery_figures(
        discovery("none"), tmp_path / "new", study="S $x_1$", workers=1, pictures="svg"
    )
    with drawing as paths:
        pass
    assert [p.name for p in paths] == [f"{n}.svg" for n in NAMES[:-1]]
    assert all(p.stat().st_size > 3000 for p in paths)


def test_makers_hold_only_what_they_draw(tmp_path: Path) -> None:
    jobs = discovery_jobs(discovery("named"), tmp_path, "S")
    assert max(len(pickle.dumps(job)) for job in jobs) < 300_000


def test_heat_map_shows_every_cell_with_its_sign_and_shape() -> None:
    grids = discovery_grids(discovery("named"))
    fig = heat_map_figure(grids, "S")
    for panel, grid in zip(fig.panels[:3], grids, strict=True):
        texts = [t.text for t in panel.texts]
        assert texts.count("gradient") + texts.count("gradient, L−R") > 0
        for cell in grid.cells.values():
            assert signed(cell.z) in texts
        assert panel.title.text.startswith(grid.title)
    assert (signed(-3.14), signed(123.4)) == ("−3.1", "+123")


def test_gap_marks_stay_on_the_axis_and_noise_is_one() -> None:
    rows = gap_rows(discovery("named"))
    fig = gap_figure(rows, "S")
    for panel in fig.panels:
        low, high = panel.x.limits
        xs = np.concatenate([np.atleast_1d(line.get_xdata()) for line in panel.lines]).astype(float)
        assert (low <= xs).all() and (xs <= high).all()
        assert "noise" in panel.x_label.text
    labels = fig.keys[0].labels
    assert labels[-1] == "noise floor" and len(labels) == 5
    fewer = gap_figure(gap_rows(discovery("none")), "S").keys[0].labels
    assert len(fewer) == 3


def test_evidence_has_a_panel_a_step_and_the_price_of_a_name() -> None:
    steps = evidence_steps(discovery("two"))
    fig = evidence_figure(steps, "S")
    for panel, step in zip(fig.panels, steps, strict=True):
        assert panel.y.ticks(9).words == tuple(c.label for c in step.candidates)
        assert any(float(np.atleast_1d(x.get_xdata())[0]) == step.needed for x in panel.lines)


def test_worst_curves_come_first_and_have_units() -> None:
    worst = worst_views(discovery("named"))
    gaps = [w.gaps["tuned"] for w in worst]
    assert gaps == sorted(gaps, reverse=True) and len(worst) == 6
    assert worst[0].gaps["with_effect"] < 1.5 < worst[0].gaps["tuned"]
    fig = curve_figure(worst, "S")
    labels = [panel.y_label.text for panel in fig.panels]
    assert sum("sd of the noise" in text for text in labels) == 6
    assert all(text.endswith("]") for text in labels)
    assert all(panel.x_label.text.endswith("]") for panel in fig.panels[3:6])


def test_friction_shows_as_half_width_of_the_loop() -> None:
    worst = worst_views(discovery("two"))
    assert worst[0].view.branches == "half_width"
    assert worst[0].label == "tyre load, half-width [N]" and ", loop\n" in worst[0].title
    assert worst[0].half is None


def test_isolability_has_a_bar_a_hypothesis_under_the_name_of_its_group() -> None:
    table = isolability(discovery("named"))
    page = isolability_figure(table, "S")
    (panel,) = page.panels
    bars = next(a for a in panel.areas if isinstance(a, PolyCollection))
    assert len(bars.get_paths()) == len(table.labels)
    words = [t.text for t in panel.texts]
    assert set(table.labels) <= set(words)
    assert sum(w.startswith(("A  ", "B  ")) for w in words) == min(2, len(table.groups))
    heads = [t for t in panel.texts if t.look.get("weight") == "bold" and t.text not in table.labels]
    assert heads and all(text_width(t.text, t.look["size"]) < panel.box.left - 14.0 for t in heads)
    assert (page.width, page.height) <= (A4[0] * 72.0 + 1e-6, A4[1] * 72.0 + 1e-6)


def test_held_out_has_a_row_a_load_case() -> None:
    cases = discovery("named").held_out
    (panel,) = held_out_figure(cases, "S").panels
    assert len(panel.y.ticks(9).words) == len(LOAD_CASES)
    assert [gain_words(v) for v in (-0.04, 12.34, 12345.0)] == ["0.0", "+12.3", "+12 345"]


def test_parameters_that_return_come_first() -> None:
    rows = moved_parameters(tuned_parameters(discovery("named")))
    change = [abs(p.with_effect_distance) - abs(p.tuned_distance) for p in rows]
    assert change == sorted(change)
    (panel,) = parameter_figure(tuned_parameters(discovery("named")), "S").panels
    assert panel.y.ticks(9).words == tuple(p.path for p in rows)


def test_no_parameter_far_off_is_left_out_for_one_that_returns() -> None:
    one = tuned_parameters(discovery("named"))[0]
    back = replace(one, tuned_distance=1.2, with_effect_distance=0.1)
    away = replace(one, path="away", tuned_distance=-1.4, with_effect_distance=-1.7)
    rows = moved_parameters([*[back] * PARAMETERS_SHOWN, away])
    assert len(rows) == PARAMETERS_SHOWN and rows[-1].path == "away"


def test_unwritable_folder_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    drawing = discovery_figures(discovery("none"), tmp_path / "out", study="S", workers=1)
    with pytest.raises(RunError, match="out"), drawing:
        pass
