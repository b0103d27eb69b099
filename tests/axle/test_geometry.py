"""Geometries that no car has are refused, those that tuning reaches are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from doe_kc.axle import design_parameters, with_values
from doe_kc.axle.geometry import NEAR_CENTRE_PLANE, check_geometry
from doe_kc.axle_file import read_axle
from doe_kc.axle_file.write import write_axle
from doe_kc.ground.errors import InputError
from tests.axle_type_reference import EXAMPLES, TYPES

DOUBLE_WISHBONE = EXAMPLES / "double_wishbone_front" / "axle.toml"


@pytest.mark.parametrize("name", TYPES)
@pytest.mark.parametrize("end", ["lower", "upper"])
def test_an_axle_at_its_bounds_can_be_written_and_read(name: str, end: str, tmp_path: Path) -> None:
    path = EXAMPLES / name / "axle.toml"
    axle = read_axle(path)
    moved = with_values(axle, {p.path: getattr(p, end) for p in design_parameters(axle) if p.active})
    written = read_axle(write_axle(moved, path, tmp_path / "axle.toml"))
    assert written.values == pytest.approx(moved.values)


@pytest.mark.parametrize(("side", "across"), [("left", 1.0), ("right", -1.0)])
def test_a_joint_of_the_centre_plane_may_be_moved_across_but_not_far(side: str, across: float) -> None:
    axle = read_axle(EXAMPLES / "twist_beam_rear" / "axle.toml")
    check_geometry(with_values(axle, {f"{side}.BC.y": across * 0.9 * NEAR_CENTRE_PLANE}), "axle.toml")
    far = with_values(axle, {f"{side}.BC.y": across * 1.1 * NEAR_CENTRE_PLANE})
    with pytest.raises(InputError, match=rf"axle\.toml: hardpoint BC of the {side} side .*Check its sign"):
        check_geometry(far, "axle.toml")


def test_an_arm_bushing_on_the_other_side_is_a_wrong_sign() -> None:
    axle = read_axle(DOUBLE_WISHBONE)
    with pytest.raises(InputError, match="hardpoint ULF of the left side lies on the other side"):
        check_geometry(with_values(axle, {"left.ULF.y": -axle.values["ULF.y@L"]}), "axle.toml")
