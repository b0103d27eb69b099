"""Kinematics of the rigid limit against a separate constraint solution of one McPherson corner.

Constraints: the lower arm turns about LLF-LLR, the strut axis (fixed in the knuckle) passes through UPB,
the tie rod keeps its length, the rack stands where it stands. Finite stiffness leaves an error that falls
as it grows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from doe_kc.axle import Axle, with_values
from doe_kc.axle.model import BUSHINGS
from doe_kc.load_cases.steer import Steer
from doe_kc.load_cases.vertical import Vertical
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.suite import solve
from tests.reference import nominal, variant

DEG, MM = 1e-2, 0.05
SOFT = 1e-4
"""Factor on rotational stiffnesses: joints turn freely."""
TOLERANT = NewtonSettings(tol=1e-4)
"""At 1e7 N/mm the rounding of a coordinate of 1000 mm is already 1e-6 N."""


def stiff(axle: Axle, factor: float) -> Axle:
    values = {"scb.Tz": factor}
    for name in BUSHINGS:
        values |= {f"{name}.F{a}": factor for a in "xyz"} | {f"{name}.T{a}": SOFT for a in "xyz"}
    cases = {
        "vertical": Vertical(amplitude=60.0, steps=6, control="wheel"),
        "steer": Steer(amplitude=350.0, steps=6),
    }
    return replace(with_values(axle, values), load_cases=cases)


class Corner:
    """The left corner as an ideal mechanism; unknowns: arm angle and the knuckle's rotation vector."""

    def __init__(self, axle: Axle) -> None:
        self.p = {
            n: np.array([axle.values[f"{n}.{a}@L"] for a in "xyz"])
            for n in ("LLF", "LLR", "LWB", "LWD", "UPB", "RIB", "ROB", "WLC")
        }
        toe, camber = (np.radians(axle.values[f"static.{n}@L"]) for n in ("toe", "camber"))
        self.spin = np.array([-np.sin(toe) * np.cos(camber), -np.cos(toe) * np.cos(camber), -np.sin(camber)])
        self.guess = np.zeros(4)

    def pose(self, q: np.ndarray) -> tuple[np.ndarray, Rotation]:
        hinge = self.p["LLR"] - self.p["LLF"]
        swing = Rotation.from_rotvec(q[0] * hinge / np.linalg.norm(hinge))
        return self.p["LLF"] + swing.apply(self.p["LWB"] - self.p["LLF"]), Rotation.from_rotvec(q[1:])

    def point(self, q: np.ndarray, name: str) -> np.ndarray:
        ball, turn = self.pose(q)
        return ball + turn.apply(self.p[name] - self.p["LWB"])

    def violation(self, q: np.ndarray, wheel_z: float, rack: float) -> np.ndarray:
        ball, turn = self.pose(q)
        axis = self.p["UPB"] - self.p["LWD"]
        # UPB seen from the knuckle must lie on the damper axis
        off = np.cross(axis, turn.inv().apply(self.p["UPB"] - ball) + self.p["LWB"] - self.p["LWD"])
        rod = self.point(q, "ROB") - self.p["RIB"] - [0.0, rack, 0.0]
        length = np.linalg.norm(rod) - np.linalg.norm(self.p["ROB"] - self.p["RIB"])
        return np.array([off[0] / 400, off[1] / 400, length, self.point(q, "WLC")[2] - wheel_z])

    def solve(self, wheel_z: float, rack: float) -> dict[str, float]:
        q, wanted = self.guess, (wheel_z, rack)
        for _ in range(8):
            steps = 1e-5 * np.eye(4)
            slopes = [self.violation(q + h, *wanted) - self.violation(q - h, *wanted) for h in steps]
            q = q - np.linalg.solve(np.array(slopes).T / 2e-5, self.violation(q, *wanted))
        assert np.abs(self.violation(q, *wanted)).max() < 1e-9
        self.guess = q
        s = self.pose(q)[1].apply(self.spin)
        centre = self.point(q, "WLC")
        return {
            "toe": np.degrees(np.arctan2(-s[0], -s[1])),
            "camber": -np.degrees(np.arcsin(s[2])),
            "wc_x": centre[0],
            "wc_y": centre[1],
        }


def errors(axle: Axle, factor: float, case: str) -> tuple[float, float]:
    """Largest error in deg and mm over both branches."""
    model = stiff(axle, factor)
    solution = solve(model, [case], compiled=False, settings=TOLERANT)
    worst = {"toe": 0.0, "camber": 0.0, "wc_x": 0.0, "wc_y": 0.0}
    for branch in solution.cases[case].branches:
        corner = Corner(model)
        for y in branch.y:
            expected = corner.solve(y[solution.column("wc_z@L")], y[solution.column("rack_travel")])
            for name, value in expected.items():
                error = abs(y[solution.column(f"{name}@L")] - value)
                worst[name] = max(worst[name], float(error))
    return max(worst["toe"], worst["camber"]), max(worst["wc_x"], worst["wc_y"])


@pytest.mark.parametrize("case", ["vertical", "steer"])
@pytest.mark.parametrize("number", [0, 1, 3])
def test_the_stiff_axle_moves_as_the_ideal_mechanism(number: int, case: str) -> None:
    axle = variant(number) if number else nominal()
    first, second = errors(axle, 1e2, case), errors(axle, 1e3, case)
    assert second[0] < DEG
    assert second[1] < MM
    assert second[0] < 2e-4  # what this stiffness really reaches
    assert second[1] < 1e-3
    # first order in the compliance
    assert second[0] < first[0] / 8
    assert second[1] < first[1] / 8


def test_the_sweep_is_large_enough_to_tell_mechanisms_apart() -> None:
    """A tie-rod ball 1 mm elsewhere misses by far more than the tolerance."""
    axle = nominal()
    solution = solve(stiff(axle, 1e3), ["vertical"], compiled=False, settings=TOLERANT)
    y = solution.cases["vertical"].branches[0].y[-1]
    other = Corner(with_values(axle, {"RIB.z": 280.0}))
    expected = other.solve(y[solution.column("wc_z@L")], y[solution.column("rack_travel")])
    assert abs(expected["toe"] - y[solution.column("toe@L")]) > 5 * DEG
