"""Pictures are drawn when their numbers are new, in the format that is asked for."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from doe_kc.campaign.executors import in_process
from doe_kc.ground.errors import RunError
from doe_kc.ground.picture_format import PictureFormat
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing import series
from doe_kc.reports.drawing.picture_digest import PictureDigests
from doe_kc.reports.drawing.series import draw_series, series_beside
from doe_kc.reports.drawing.sheet import Sheet, sheet


@dataclass(frozen=True)
class Line:
    y: FloatArray
    title: str = "Line"
    seconds: float = 0.0


def line_figure(line: Line) -> Sheet:
    page, panels = sheet(1, 1, size=(3.0, 2.0), margins={})
    panels[0, 0].plot(np.arange(line.y.size), line.y)
    page.set_heading(line.title, 0.98)
    return page


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


@pytest.mark.parametrize(("count", "workers"), [(series.FEW, 1), (series.FEW + 1, 2)])
def test_a_few_are_drawn_in_this_process(
    count: int, workers: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []

    def here(number: int) -> Executor:
        asked.append(number)
        return in_process()

    monkeypatch.setattr(series, "processes", here)
    draw_series([(tmp_path / f"{k}", partial(line_figure, LINE)) for k in range(count)], 2)
    assert asked == [workers] and len(list(tmp_path.iterdir())) == count


def test_pictures_are_drawn_beside_other_work(tmp_path: Path) -> None:
    """What fails beside them is told after the last one."""
    jobs = [(tmp_path / f"{k}", partial(line_figure, LINE)) for k in range(series.FEW + 1)]
    with series_beside(jobs, 2) as paths:
        assert [p.name for p in paths] == [f"{k}.png" for k in range(len(jobs))]
        (tmp_path / "page").write_text("beside")
    assert all(p.exists() for p in paths)
    with pytest.raises(RunError, match="page"), series_beside(jobs, 2, pictures="svg"):
        raise RunError("page: no")
    with series_beside(jobs, pictures="none") as none:
        assert none == []
