"""Pictures of the axle types: all in one scale each, nothing beyond the page, both sides."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle.geometry import point
from doe_kc.axle.members import members_of, shared_parts
from doe_kc.axle_file import read_axle
from doe_kc.axle_types import BUILT_IN
from doe_kc.examples import example_folder
from doe_kc.reports.axle.type_figures import TypeExample, type_catalogue
from tests.cli.runner import succeeds


@pytest.fixture(scope="module")
def examples() -> list[TypeExample]:
    return [TypeExample(n, f"Label of {n}", read_axle(example_folder(n) / "axle.toml")) for n in BUILT_IN]


def test_every_type_in_one_scale_and_nothing_beyond_the_page(examples: list[TypeExample]) -> None:
    page = type_catalogue(examples)
    assert page.outside == []
    texts = {word.text for word in page.words}
    assert {f"Label of {n}: {n}" for n in BUILT_IN} <= texts
    for panel in page.panels:
        scales = [
            np.diff(axis.limits)[0] / size
            for axis, size in ((panel.x, panel.box.width), (panel.y, panel.box.height))
        ]
        assert scales[0] == pytest.approx(scales[1])
        for line in panel.lines:
            assert panel.x.limits[0] <= np.min(line.get_xdata())
            assert np.max(line.get_xdata()) <= panel.x.limits[1]


def test_parts_of_both_sides_are_those_of_the_single_bodies(examples: list[TypeExample]) -> None:
    parts = {e.name: shared_parts(e.axle) & members_of(e.axle).keys() for e in examples}
    assert parts["rigid_rear"] == {"axle"}
    assert parts["mcpherson_front"] == parts["five_link_rear"] == {"sub-frame"}
    assert parts["twist_beam_rear"] == set()


def test_a_wheel_keeps_its_size_along_the_page(examples: list[TypeExample]) -> None:
    """A circle seen at a slant is an ellipse whose longer half-axis is its radius."""
    for example, panel in zip(examples, type_catalogue(examples).panels, strict=True):
        rim = np.column_stack([panel.lines[0].get_xdata(), panel.lines[0].get_ydata()])
        longest = np.linalg.norm(rim - rim[:-1].mean(axis=0), axis=1).max()
        assert longest == pytest.approx(point(example.axle, "WLC")[2], rel=2e-3)


def test_the_command_writes_all_and_each(tmp_path: Path) -> None:
    said = succeeds("types", "--out", str(tmp_path / "types"), "--pictures", "svg").out
    assert f"{len(BUILT_IN) + 1} pictures in" in said
    assert {p.name for p in (tmp_path / "types").iterdir()} >= {f"{n}.svg" for n in ("axle_types", *BUILT_IN)}
