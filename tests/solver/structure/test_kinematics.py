"""Axles with joints in place of their bushings, against rigid distances solved by scipy alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from doe_kc.axle import Axle, with_values
from doe_kc.axle.kinematics import as_mechanism
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError
from doe_kc.solver.newton import RIGID_SETTINGS
from doe_kc.solver.result import Solution
from doe_kc.solver.suite import solve
from tests.axle_type_reference import nominal

RODS = {
    "five_link_rear": (("UFI", "UFO"), ("URI", "URO"), ("LFI", "LFO"), ("SLI", "SLO"), ("TLI", "TLO")),
    "double_wishbone_front": (
        *(("LLF", "LBJ"), ("LLR", "LBJ"), ("ULF", "UBJ"), ("ULR", "UBJ"), ("RIB", "ROB")),
    ),
    "semi_trailing_rear": (),
}
"""(fixed point, point on the carrier) of constant distance."""
PINS = {"semi_trailing_rear": ("AOB", "AIB")}
"""Points of the carrier that stay where they are."""
MM, DEG = 5e-5, 5e-6
"""Forces of some kN through joints of 1e9 N/mm."""


class Corner:
    """The left carrier; unknowns: its wheel centre's shift and rotation vector."""

    def __init__(self, axle: Axle, axle_type: str) -> None:
        names = {*sum(RODS[axle_type], ()), *PINS.get(axle_type, ()), "WLC"}
        self.p = {n: np.array([axle.values[f"{n}.{a}@L"] for a in "xyz"]) for n in names}
        self.rods, self.pins = RODS[axle_type], PINS.get(axle_type, ())
        toe, camber = (np.radians(axle.values[f"static.{n}@L"]) for n in ("toe", "camber"))
        self.spin = np.array([-np.sin(toe) * np.cos(camber), -np.cos(toe) * np.cos(camber), -np.sin(camber)])
        self.guess = np.zeros(6)

    def point(self, q: np.ndarray, name: str) -> np.ndarray:
        turned = Rotation.from_rotvec(q[3:]).apply(self.p[name] - self.p["WLC"])
        return self.p["WLC"] + q[:3] + turned

    def violation(self, q: np.ndarray, wheel_z: float, rack: float) -> np.ndarray:
        out = [self.point(q, "WLC")[2] - wheel_z]
        for fixed, moved in self.rods:
            start = self.p[fixed] + ([0.0, rack, 0.0] if fixed == "RIB" else 0.0)
            length = np.linalg.norm(self.p[moved] - self.p[fixed])
            out.append(np.linalg.norm(self.point(q, moved) - start) - length)
        for pin in self.pins:
            out += list(self.point(q, pin) - self.p[pin])
        return np.array(out)

    def solve(self, wheel_z: float, rack: float) -> dict[str, float]:
        done = least_squares(
            self.violation, self.guess, args=(wheel_z, rack), x_scale=[1.0] * 3 + [1e-3] * 3,
            xtol=1e-15, ftol=1e-15, gtol=1e-15,
        )  # fmt: skip
        assert np.abs(done.fun).max() < 1e-7
        self.guess = done.x
        s = Rotation.from_rotvec(done.x[3:]).apply(self.spin)
        x, y, _ = self.point(done.x, "WLC")
        return {
            "wc_x": x,
            "wc_y": y,
            "toe": np.degrees(np.arctan2(-s[0], -s[1])),
            "camber": -np.degrees(np.arcsin(s[2])),
        }


def mechanism(axle_type: str, values: dict[str, float] | None = None) -> tuple[Axle, Solution]:
    axle = with_values(nominal(axle_type), values or {})
    cases = {i: replace(c, steps=6) for i, c in axle.load_cases.items() if i in ("vertical", "roll", "steer")}
    axle = replace(axle, load_cases=cases)
    return axle, solve(as_mechanism(axle), compiled=False, settings=RIGID_SETTINGS)


@pytest.mark.parametrize(
    ("axle_type", "values"),
    [
        ("five_link_rear", {}),
        ("five_link_rear", {"TLI.z": 236.0, "URO.y": -702.0, "static.toe": 0.3}),
        ("double_wishbone_front", {}),
        ("double_wishbone_front", {"ROB.z": 190.0, "ULF.z": 530.0}),
        ("semi_trailing_rear", {}),
    ],
)
def test_wheels_move_as_rigid_links_let_them(axle_type: str, values: dict[str, float]) -> None:
    axle, solution = mechanism(axle_type, values)
    compared = 0
    for ident, case in solution.cases.items():
        for branch in case.branches:
            corner = Corner(axle, axle_type)
            for row in branch.y:
                rack = row[solution.column("rack_travel")] if ident == "steer" else 0.0
                wanted = corner.solve(row[solution.column("wc_z@L")], rack)
                for name, value in wanted.items():
                    tolerance = MM if name.startswith("wc") else DEG
                    assert row[solution.column(f"{name}@L")] == pytest.approx(value, abs=tolerance), (
                        ident,
                        name,
                    )
                    compared += 1
    assert compared > 80


def test_bushings_matter() -> None:
    """The same curves with bushings are far outside the tolerance."""
    axle = nominal("five_link_rear")
    soft = solve(axle, ["vertical"], compiled=False)
    corner = Corner(axle, "five_link_rear")
    (row,) = soft.cases["vertical"].branches[0].y[-1:]
    for share in np.linspace(0.1, 1.0, 10):
        start = axle.values["WLC.z@L"]
        wanted = corner.solve(start + share * (row[soft.column("wc_z@L")] - start), 0.0)
    assert abs(row[soft.column("toe@L")] - wanted["toe"]) > 1000 * DEG


def test_the_two_halves_of_a_twist_beam_turn_about_their_joint() -> None:
    """The arms pivot on their bushings, and turn against each other about Y at the cross-beam alone."""
    axle, solution = mechanism("twist_beam_rear")
    pivot = np.array([axle.values[f"TAB.{a}@L"] for a in "xyz"])
    design = np.array([axle.values[f"WLC.{a}@L"] for a in "xyz"])
    for case in ("vertical", "roll"):
        for branch in solution.cases[case].branches:
            places = branch.y[:, [solution.column(f"wc_{a}@L") for a in "xyz"]]
            distance = np.linalg.norm(places - pivot, axis=1)
            assert distance == pytest.approx(np.linalg.norm(design - pivot), abs=MM)
    rolled = solution.cases["roll"].branches[0].y[-1]
    assert abs(rolled[solution.column("camber@L")] - rolled[solution.column("camber@R")]) > 0.1


def test_links_that_bind_are_told() -> None:
    with pytest.raises(InputError, match="a rigid_rear move up and down only together: its links bind"):
        as_mechanism(nominal("rigid_rear"))


def test_elastic_effects_are_refused() -> None:
    axle = apply_effect(nominal("five_link_rear"), "hub_compliance", {}, source="test")
    with pytest.raises(InputError, match=r"effect hub_compliance.*remove \[effects.hub_compliance\]"):
        as_mechanism(axle)
    raised = apply_effect(nominal("five_link_rear"), "ride_height_offset", {}, source="test")
    assert as_mechanism(raised).effects == raised.effects
