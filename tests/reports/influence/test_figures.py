"""Heat map and top-ten bars of an influence study."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection, QuadMesh

from doe_kc.ground.errors import RunError
from doe_kc.reports.influence.figures import (
    diverging,
    influence_bars,
    influence_heat_map,
    write_influence_figures,
)
from tests.parameter_influence.studies import parameter, study


def test_files_are_written(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        paths = write_influence_figures(study([[1.0, -2.0], [0.5, 1.0]]), tmp_path / "new", study="S")
    assert [p.name for p in paths] == ["influence_heat_map.png", "influence_top_ten.png"]
    assert all(p.stat().st_size > 5000 for p in paths)


def test_heat_map_has_fixed_limits_and_white_zero() -> None:
    page = influence_heat_map(study([[1.0, 2.0], [0.5, -0.02]]), study="S")
    assert page.outside == []
    mesh = next(c for c in page.panels[0].areas if isinstance(c, QuadMesh))
    assert mesh.get_clim() == (-100.0, 100.0)
    np.testing.assert_allclose(diverging()(0.5)[:3], 1.0, atol=0.01)


def test_numbers_stand_from_five_percent_on() -> None:
    panel = influence_heat_map(study([[100.0], [-5.0], [4.9], [0.0]]), study="S").panels[0]
    numbers = [t.text for t in panel.texts if t.text.lstrip("-").isdigit()]
    assert numbers == ["100", "-5"]


def test_it_says_its_steps_and_what_a_blank_means() -> None:
    parameters = (
        parameter("LLF.x"), parameter("LLF.y"),
        parameter("llr.Fx", unit="-", nominal=1.0, step=0.1, group="BUSHINGS"),
        parameter("static.toe", unit="deg", nominal=0.05, step=0.1, group="OTHER"),
        parameter("spring.rate", unit="N/mm", nominal=28.0, step=2.8, group="OTHER"),
        parameter("arb.radius", unit="N/mm", nominal=10.0, step=2.0, group="OTHER"),
    )  # fmt: skip
    page = influence_heat_map(study([[1.0]] * 6, parameters=parameters), study="S")
    (words,) = [w.text for w in page.words if w.text.startswith("One parameter")]
    assert "hardpoints ±1 mm, bushings ±10 %, others as beside their name" in words
    assert "Blank: below 5 %" in words
    rows = page.panels[0].y.ticks(9).words
    assert rows[:3] == ("LLF.x", "LLF.y", "llr.Fx")
    assert set(rows[3:]) == {"static.toe (±0.1 deg)", "spring.rate (±10 %)", "arb.radius (±20 %)"}


def test_numbers_have_true_minus_signs() -> None:
    page = influence_heat_map(study([[100.0], [-50.0]]), study="run-2 of 2026-11-22")
    words = [w.text for w in page.words]
    assert "\N{MINUS SIGN}50" in words and "-50" not in words
    assert any(w.endswith("run-2 of 2026-11-22") for w in words)


def test_load_cases_head_their_columns() -> None:
    panel = influence_heat_map(study([[1.0, 1.0, 1.0]]), study="S").panels[0]
    assert {"Vertical\nmotion", "Roll\nmotion", "Brake\nforce"} <= {t.text for t in panel.texts}


def test_bars_are_the_ten_strongest_with_sign() -> None:
    change = [[float(k if k % 2 else -k)] for k in range(1, 15)]
    page = influence_bars(study(change), study="S")
    (panel,) = page.panels
    assert page.outside == []
    (bars,) = panel.areas
    assert isinstance(bars, PolyCollection)
    corners = np.array([path.vertices for path in bars.get_paths()])
    widths = corners[:, 1, 0] - corners[:, 0, 0]
    np.testing.assert_allclose(widths, [100 / 14 * (k if k % 2 else -k) for k in range(14, 4, -1)])
    assert panel.y.ticks(9).words[0] == "P13.x"


def test_failed_row_stays_grey_and_column_without_entry_empty() -> None:
    part = study([[np.nan, 0.0], [1.0, 0.0]])
    mesh = influence_heat_map(part, study="S").panels[0].areas[0]
    assert isinstance(mesh, QuadMesh)
    assert np.ma.count_masked(np.ma.asarray(mesh.get_array())) == 1
    assert not influence_bars(part, study="S").panels[1].areas


def test_unwritable_folder_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    with pytest.raises(RunError, match="out"):
        write_influence_figures(study([[1.0]]), tmp_path / "out", study="S")
