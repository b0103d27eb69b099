"""Pictures are drawn when their numbers are new, in the format that is asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from doe_kc.pictures import PictureFormat
from doe_kc.reporting import style
from doe_kc.reporting.picture_digest import PictureDigests
from doe_kc.reporting.plain_axes import draw_plain_axes
from doe_kc.reporting.series import draw_series
from doe_kc.typing import FloatArray


@dataclass(frozen=True)
class Line:
    y: FloatArray
    title: str = "Line"
    seconds: float = 0.0


def line_figure(line: Line) -> Figure:
    fig, axes = style.figure(1, 1, size=(3.0, 2.0))
    axes[0, 0].plot(line.y)
    fig.suptitle(line.title)
    return fig


LINE = Line(np.array([1.0, 2.0, 4.0]))


@pytest.mark.parametrize("form", ["png", "svg"])
def test_only_new_numbers_are_drawn(form: PictureFormat, tmp_path: Path) -> None:
    def drawn(line: Line) -> bool:
        path = tmp_path / f"a.{form}"
        before = path.stat().st_mtime_ns if path.exists() else 0
        assert draw_series([(tmp_path / "a", partial(line_figure, line))], 1, pictures=form) == [path]
        return path.stat().st_mtime_ns != before

    assert drawn(LINE)
    assert not drawn(LINE) and not drawn(replace(LINE, seconds=3.0))
    assert drawn(replace(LINE, y=LINE.y + 1e-15 * np.arange(1, 4)))
    assert drawn(LINE)
    damaged = tmp_path / f"a.{form}"
    damaged.write_bytes(damaged.read_bytes()[:-40])
    assert drawn(LINE)


def test_none_are_drawn(tmp_path: Path) -> None:
    assert draw_series([(tmp_path / "a", partial(line_figure, LINE))], pictures="none") == []
    assert not list(tmp_path.iterdir())


def test_older_numbers_in_the_other_format_are_removed(tmp_path: Path) -> None:
    job = tmp_path / "a", partial(line_figure, LINE)
    draw_series([job], 1, pictures="svg")
    draw_series([job], 1, pictures="png")
    assert len(list(tmp_path.iterdir())) == 2
    draw_series([(tmp_path / "a", partial(line_figure, replace(LINE, title="New")))], 1, pictures="png")
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]
    (tmp_path / "a.svg").write_text("<svg>of the user</svg>")
    draw_series([job], 1, pictures="png")
    assert (tmp_path / "a.svg").exists()


def test_digests_tell_values_apart() -> None:
    def digest(value: object) -> str | None:
        return PictureDigests().of(partial(line_figure, value))  # type: ignore[arg-type]

    values = [
        1,
        1.0,
        "1",
        b"1",
        None,
        (1,),
        (1, 2),
        ((1,), 2),
        {"a": 1},
        {"b": 1},
        np.ones(1),
        np.ones((1, 1)),
    ]
    digests = [digest(v) for v in values]
    assert None not in digests and len(set(digests)) == len(values)
    assert digest(lambda: None) != digest(line_figure)
    assert digest(iter(())) is None


def test_plain_axes_keep_limits_ticks_and_labels() -> None:
    fig, axes = style.figure(2, 1, size=(3.0, 4.0), share_x=True, margins={"left": 0.2, "bottom": 0.2})
    for ax in axes[:, 0]:
        ax.plot([0.0, 10.0], [-3.0, 3.0])
        ax.set_ylabel("Δ toe [deg]")
        ax.yaxis.set_major_locator(style.ticks(4))
    axes[1, 0].set_ylim(3.0, -3.0)
    draw_plain_axes(fig)
    upper, lower = axes[:, 0]
    numbers = [t for t in lower.texts if t.get_text().lstrip("−").replace(".", "").isdigit()]
    heights = {t.get_text(): t.get_position()[1] for t in numbers if t.get_position()[0] < 0.0}
    assert heights["0"] == pytest.approx(0.5) and heights["2"] == pytest.approx(1.0 / 6.0)
    assert [t.get_text() for t in lower.texts].count("Δ toe [deg]") == 1
    below = [t for t in upper.texts if t.get_position()[1] < 0.0]
    assert not below and any(t.get_position()[1] < 0.0 for t in lower.texts)
    assert upper.get_ylim() == pytest.approx((-3.3, 3.3)) and not upper.axison
