"""Type files: what is read, and what is refused in which words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import design_parameters
from doe_kc.axle_file import read_axle
from doe_kc.axle_types import BUILT_IN, DEFAULT_TYPE, read_axle_type
from doe_kc.axle_types.read import FOLDER, bushing_axes
from doe_kc.ground.errors import InputError
from tests.axle_type_reference import EXAMPLES, TYPES, nominal
from tests.reference import nominal as default_axle

TEXT = (FOLDER / "five_link_rear.toml").read_text(encoding="utf-8")


def test_every_built_in_type_has_an_example_and_is_compared_with_another_code() -> None:
    assert set(BUILT_IN) == {*TYPES, DEFAULT_TYPE}
    assert all((EXAMPLES / name / "axle.toml").is_file() for name in TYPES)
    assert default_axle().topology.structure.type == DEFAULT_TYPE


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_element_and_point_has_a_label(name: str) -> None:
    axle_type = read_axle_type(name, Path(), source="axle.toml")
    structure = axle_type.structure
    assert structure.type == name
    for point in (*structure.points, *structure.single_points, *(b.name for b in structure.bushings)):
        assert axle_type.labels[point].strip() and axle_type.labels[point] != point


def test_an_unknown_type_is_answered_with_those_that_there_are() -> None:
    with pytest.raises(InputError, match=r"axle.toml: type = 'five_link' is no axle type.*five_link_rear"):
        read_axle_type("five_link", Path(), source="axle.toml")


def test_a_type_of_the_user_s_own_beside_the_axle_file(tmp_path: Path) -> None:
    own = TEXT.replace('type = "five_link_rear"', 'type = "own"')
    (tmp_path / "own.toml").write_text(own, encoding="utf-8")
    axle_text = (EXAMPLES / "five_link_rear" / "axle.toml").read_text(encoding="utf-8")
    (tmp_path / "axle.toml").write_text(axle_text.replace('"five_link_rear"', '"own.toml"'), encoding="utf-8")
    axle = read_axle(tmp_path / "axle.toml")
    assert axle.values == nominal("five_link_rear").values


def test_axes_are_orthonormal_and_e1_lies_along_x() -> None:
    axes = np.array(bushing_axes([1.0, 1.0, 0.0], [0.0, 2.0, 0.5], "here"))
    assert np.allclose(axes.T @ axes, np.eye(3), atol=1e-15)
    assert np.allclose(axes[:, 0], np.array([1.0, 1.0, 0.0]) / np.sqrt(2.0))
    with pytest.raises(InputError, match="here: x and y span no plane"):
        bushing_axes([1.0, 0.0, 0.0], [2.0, 0.0, 0.0], "here")


@pytest.mark.parametrize("name", BUILT_IN)
def test_design_parameters_are_those_of_the_type(name: str) -> None:
    axle = default_axle() if name == DEFAULT_TYPE else nominal(name)
    paths, structure = {p.path for p in design_parameters(axle)}, axle.topology.structure
    points = {*structure.design_points, *structure.single_points} - set(axle.follow)
    assert {f"{p}.{axis}" for p in points for axis in "xyz"} <= paths
    assert not {path for path in paths if path.split(".")[0] in structure.fixed_points}
    assert {f"{b.name}.Fy" for b in structure.bushings} <= paths
    assert ("scb.Tz" in paths) == (structure.rack is not None)
    assert ("arb.radius" in paths) == (structure.bar is not None)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("TLI = [", "TLX = [", "hardpoints.TLX is unknown to the type five_link_rear.*TLI"),
        ("[bushings.tli]", "[bushings.tlx]", "bushings.tlx is unknown"),
        ("[spring]\n", "[springs]\n", "spring"),
        ("[arb]\nrate = 14.0\n", "", r"\[arb\] is missing"),
        (
            "[arb]\n",
            "[steering]\ncolumn = 1.0\nrack_mm_per_rev = 50.0\n[arb]\n",
            r"\[steering\] is for nothing",
        ),
        ("TLI = [196.0, -318.0", "TLI = [196.0, 318.0", "TLI of the left side lies on the other side"),
        ("UPS = [46.0, -548.0, 455.0]", "UPS = [42.0, -560.0, 214.0]", "spring has no length"),
    ],
)
def test_a_wrong_axle_file_is_refused_in_words(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = (EXAMPLES / "five_link_rear" / "axle.toml").read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "axle.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=f"(?s){message}") as error:
        read_axle(tmp_path / "axle.toml")
    assert "axle.toml" in str(error.value)
