"""The deformed shape: the same equilibria as the outputs, rigid members as long as at design."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from doe_kc.axle.geometry import point
from doe_kc.axle.model import Axle
from doe_kc.effects import apply_effect
from doe_kc.solver.shape import Shape, shape_at
from doe_kc.solver.suite import solve
from tests.reference import nominal

RIGID = (("LLF", "LLR", "LWB"), ("LWB", "LWD", "SAH", "ROB"), ("RIB", "ROB"), ("SFF", "SFR"))
"""Hardpoints that keep their distances in an axle without effects."""


def ends(axle: Axle, case: str) -> list[tuple[Shape, dict[str, float]]]:
    """Shape and outputs where a branch ends."""
    solution = solve(axle, [case], compiled=False)
    return [
        (shape_at(axle, b, -1), dict(zip(solution.output_names, b.y[-1], strict=True)))
        for b in solution.cases[case].branches
    ]


@pytest.mark.parametrize("case", ["vertical", "lateral_offset", "steer"])
def test_wheel_and_contact_are_where_the_outputs_say(case: str) -> None:
    for shape, outputs in ends(nominal(), case):
        for side in "LR":
            wheel = [outputs[f"wc_{axis}@{side}"] for axis in "xyz"]
            np.testing.assert_allclose(shape.points[f"WLC@{side}"], wheel, atol=1e-9)
            contact = [outputs[f"cp_{axis}@{side}"] for axis in "xyz"]
            np.testing.assert_allclose(shape.contact[side], contact, atol=1e-9)
            camber = -np.degrees(np.arcsin(shape.spin[side][2]))
            assert camber == pytest.approx(outputs[f"camber@{side}"], abs=1e-9)


def test_rigid_members_keep_their_length_and_mounts_their_place() -> None:
    axle, names = nominal(), nominal().topology.structure.design_points
    for shape, outputs in ends(axle, "roll"):
        assert set(shape.points) == {f"{name}@{side}" for name in names for side in "LR"}
        for a, b in (pair for member in RIGID for pair in combinations(member, 2)):
            now = np.linalg.norm(shape.points[f"{a}@L"] - shape.points[f"{b}@L"])
            assert now == pytest.approx(np.linalg.norm(point(axle, a) - point(axle, b)), abs=1e-6)
        np.testing.assert_allclose(shape.points["UPS@L"], point(axle, "UPS"), atol=1e-12)
        strut = [np.linalg.norm(shape.points["UPB@L"] - shape.points["LWD@L"])]
        strut.append(np.linalg.norm(point(axle, "UPB") - point(axle, "LWD")))
        assert strut[1] - strut[0] == pytest.approx(outputs["strut_compression@L"], abs=1e-6)


def test_a_sprung_wheel_turns_about_its_centre() -> None:
    axle = apply_effect(
        nominal(), "hub_compliance", {"camber_Nm_deg": 5000.0, "toe_Nm_deg": 9000.0}, source="test"
    )
    for shape, outputs in ends(axle, "lateral"):
        assert -np.degrees(np.arcsin(shape.spin["L"][2])) == pytest.approx(outputs["camber@L"], abs=1e-9)
        np.testing.assert_allclose(np.linalg.norm(shape.spin["L"]), 1.0)
