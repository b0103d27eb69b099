"""Free motions and motions held twice, in words of bodies and points."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from doe_kc.axle.freedoms import check_freedoms
from doe_kc.axle.structure import BallConnection, Structure
from doe_kc.ground.errors import InputError
from tests.axle_type_reference import TYPES, nominal


def without(axle_type: str, kind: str, name: str) -> Structure:
    """The type without one element."""
    structure = nominal(axle_type).topology.structure
    rest: Any = tuple(e for e in getattr(structure, kind) if e.name != name)
    assert len(rest) < len(getattr(structure, kind))
    return replace(structure, **{kind: rest})


@pytest.mark.parametrize("axle_type", TYPES)
def test_a_sound_type_has_neither(axle_type: str) -> None:
    axle = nominal(axle_type)
    check_freedoms(axle, axle.topology.structure, "type")


@pytest.mark.parametrize(
    ("axle_type", "kind", "name", "motion"),
    [
        ("double_wishbone_front", "rods", "tie_rod", r"knuckle \w+ turns about the line LBJ-UBJ"),
        ("double_wishbone_front", "balls", "ubj", r"knuckle \w+ turns about LBJ in 2 ways"),
        ("five_link_rear", "bushings", "tli", r"toe link \w+ turns about TLO in 3 ways"),
        ("twist_beam_rear", "bushings", "beam_joint", "beam moves in 6 ways"),
        ("rigid_rear", "bushings", "phb", "panhard"),
    ],
)
def test_what_nothing_resists_is_named(axle_type: str, kind: str, name: str, motion: str) -> None:
    with pytest.raises(InputError, match=rf"axle\.toml: nothing resists that {motion}"):
        check_freedoms(nominal(axle_type), without(axle_type, kind, name), "axle.toml")


def test_joints_that_hold_a_motion_twice_are_named() -> None:
    axle = nominal("five_link_rear")
    structure = axle.topology.structure
    more = tuple(BallConnection(f"extra_{at.lower()}", "toe_link", "knuckle", at) for at in ("UFO", "URO"))
    check_freedoms(axle, replace(structure, balls=(*structure.balls, *more[:0])), "type")
    with pytest.raises(InputError, match=r"held twice by .*tlo.*; put a bushing"):
        check_freedoms(axle, replace(structure, balls=(*structure.balls, *more)), "type")
