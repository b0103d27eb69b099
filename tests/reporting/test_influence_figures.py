"""Heat map and top-ten bars of an influence study."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import QuadMesh

from doe_kc.errors import RunError
from doe_kc.reporting.influence_figures import (
    diverging,
    influence_bars,
    influence_heat_map,
    write_influence_figures,
)
from tests.influence.studies import study


def test_files_are_written(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        paths = write_influence_figures(study([[1.0, -2.0], [0.5, 1.0]]), tmp_path / "new", study="S")
    assert [p.name for p in paths] == ["influence_heat_map.png", "influence_top_ten.png"]
    assert all(p.stat().st_size > 5000 for p in paths)


def test_heat_map_has_fixed_limits_and_white_zero() -> None:
    ax = influence_heat_map(study([[1.0, 2.0], [0.5, -0.02]]), study="S").axes[0]
    mesh = next(c for c in ax.collections if isinstance(c, QuadMesh))
    assert mesh.get_clim() == (-100.0, 100.0)
    np.testing.assert_allclose(diverging()(0.5)[:3], 1.0, atol=0.01)


def test_numbers_stand_from_five_percent_on() -> None:
    ax = influence_heat_map(study([[100.0], [-5.0], [4.9], [0.0]]), study="S").axes[0]
    numbers = [t.get_text() for t in ax.texts if t.get_text().lstrip("-").isdigit()]
    assert numbers == ["100", "-5"]


def test_load_cases_head_their_columns() -> None:
    ax = influence_heat_map(study([[1.0, 1.0, 1.0]]), study="S").axes[0]
    assert {"Vertical\nmotion", "Roll\nmotion", "Brake\nforce"} <= {t.get_text() for t in ax.texts}


def test_bars_are_the_ten_strongest_with_sign() -> None:
    change = [[float(k if k % 2 else -k)] for k in range(1, 15)]
    (ax,) = [a for a in influence_bars(study(change), study="S").axes if a.get_visible()]
    widths = [bar.get_width() for bar in ax.patches]
    np.testing.assert_allclose(widths, [100 / 14 * (k if k % 2 else -k) for k in range(14, 4, -1)])
    assert ax.get_yticklabels()[0].get_text() == "P13.x"


def test_failed_row_stays_grey_and_column_without_entry_empty() -> None:
    part = study([[np.nan, 0.0], [1.0, 0.0]])
    mesh = influence_heat_map(part, study="S").axes[0].collections[0]
    assert np.ma.count_masked(np.ma.asarray(mesh.get_array())) == 1
    assert not influence_bars(part, study="S").axes[1].patches


def test_unwritable_folder_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    with pytest.raises(RunError, match="out"):
        write_influence_figures(study([[1.0]]), tmp_path / "out", study="S")
