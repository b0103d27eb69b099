"""Energy: what pads, forces and pinion put in is stored, comes back on a closed loop, or is dissipated."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import simpson

from doe_kc.effects import apply_effect
from doe_kc.solver.equilibria import March
from tests.reference import nominal
from tests.solver.independent import evaluate, tyre_energy
from tests.solver.tangent import Rig

STEPS = 32


@pytest.fixture(scope="module")
def rig() -> Rig:
    return Rig(nominal())


def segments(values: np.ndarray, steps: int) -> list[np.ndarray]:
    return [values[i : i + steps + 1] for i in range(0, len(values) - 1, steps)]


def work(rig: Rig, path: March, steps: int) -> np.ndarray:
    """Work in N mm on each straight piece: pads, drive forces and pinion, each with its conjugate."""
    total = np.zeros(len(path.x) // steps)
    for force, travel, sign in (
        (rig.output(path, "tyre_load@L"), rig.input("pad_L"), 1.0),
        (rig.output(path, "tyre_load@R"), rig.input("pad_R"), 1.0),
        (rig.output(path, "column_force"), rig.input("rack"), 1.0),
        (rig.input("drive_L"), rig.output(path, "wc_x@L"), -1.0),
        (rig.input("drive_R"), rig.output(path, "wc_x@R"), -1.0),
    ):
        for i, (f, s) in enumerate(zip(segments(force, steps), segments(travel, steps), strict=True)):
            parts = np.arange(steps + 1.0)
            slope = np.gradient(s, parts, edge_order=2)
            if np.ptp(f) == 0 or np.ptp(s) == 0:
                total[i] += sign * f[0] * (s[-1] - s[0]) if np.ptp(f) == 0 else 0.0
            elif np.allclose(slope, slope[0], rtol=1e-9):
                total[i] += sign * simpson(f, x=s)
            else:  # int f ds = [f s] - int s df, f linear along the piece
                total[i] += sign * (f[-1] * s[-1] - f[0] * s[0] - simpson(s, x=f))
    return total


def stored(rig: Rig, path: March) -> np.ndarray:
    """Energy in N mm at the start and at every equilibrium."""
    names = rig.kernel.layout.output_names
    rows = [(rig.static.x, rig.controls(1, {})[0], rig.static.y), *zip(path.x, rig.u, path.y, strict=True)]
    return np.array(
        [
            evaluate(rig.axle, rig.kernel, x, u).energy
            + tyre_energy(rig.axle, dict(zip(names, y, strict=True)))
            for x, u, y in rows
        ]
    )


@pytest.mark.parametrize(
    "to",
    [
        {"pad_L": 20.0, "pad_R": 20.0},
        {"pad_L": -40.0, "pad_R": -40.0},
        {"pad_L": 18.0, "pad_R": -18.0},
        {"drive_L": 2000.0, "drive_R": 2000.0},
        {"drive_L": -2000.0, "drive_R": 1000.0},
        {"rack": 50.0},
    ],
    ids=lambda to: " ".join(f"{k}{v:+g}" for k, v in to.items()),
)
def test_work_along_a_sweep_is_the_change_of_the_stored_energy(rig: Rig, to: dict[str, float]) -> None:
    path = rig.path([to], STEPS)
    energy = stored(rig, path)
    assert work(rig, path, STEPS)[0] == pytest.approx(energy[-1] - energy[0], rel=1e-6, abs=1e-2)


def test_the_balance_holds_through_stops_and_lift_off_as_the_sweep_gets_finer(rig: Rig) -> None:
    errors = []
    for steps in (48, 144):
        path = rig.path([{"pad_L": 80.0, "pad_R": 80.0}, {"pad_L": -200.0, "pad_R": -200.0}], steps)
        energy = stored(rig, path)
        errors.append(abs(work(rig, path, steps).sum() / (energy[-1] - energy[0]) - 1))
    assert rig.output(path, "tyre_load@L")[-1] == 0.0
    assert rig.output(path, "stop@L").max() > 1000.0
    assert errors[1] < errors[0] / 4
    assert errors[1] < 1e-4


def test_a_closed_loop_of_pads_drive_and_steer_gives_all_energy_back(rig: Rig) -> None:
    corners = [
        {"pad_L": 20.0, "pad_R": 15.0},
        {"pad_L": 20.0, "pad_R": 15.0, "drive_L": 2000.0, "drive_R": 500.0},
        {"pad_L": 20.0, "pad_R": 15.0, "drive_L": 2000.0, "drive_R": 500.0, "rack": 30.0},
        {"drive_L": 2000.0, "drive_R": 500.0, "rack": 30.0},
        {"rack": 30.0},
        {},
    ]
    path = rig.path(corners, STEPS)
    pieces = work(rig, path, STEPS)
    assert np.abs(pieces).max() > 1e5
    assert abs(pieces.sum()) < 1e-6 * np.abs(pieces).sum()
    np.testing.assert_allclose(path.y[-1], rig.static.y, rtol=0, atol=1e-6)


@pytest.mark.parametrize("law", ["dahl", "iwan"])
def test_what_a_steering_loop_takes_is_what_friction_dissipates(law: str) -> None:
    axle = apply_effect(nominal(), "steering_friction", {"law": law}, source="test")
    rig, steps = Rig(axle), 200
    path = rig.path([{"rack": a} for a in (30.0, -30.0, 30.0)], steps, load_case=True)
    _, down, up = work(rig, path, steps)
    column, travel = rig.output(path, "column_force")[steps:], rig.output(path, "rack_travel")[steps:]
    back = column + rig.output(path, "rack_force")[steps:]
    friction = segments(back, steps), segments(travel, steps)
    dissipated = sum(np.trapezoid(f, s) for f, s in zip(*friction, strict=True))
    assert down + up == pytest.approx(dissipated, rel=2e-3)
    # a loop of 2 x 60 mm against 250 N, less the pre-sliding at two reversals
    assert dissipated == pytest.approx(250.0 * 120.0, rel=0.02)


def test_without_friction_the_same_loop_takes_nothing(rig: Rig) -> None:
    path = rig.path([{"rack": a} for a in (30.0, -30.0, 30.0)], STEPS)
    _, down, up = work(rig, path, STEPS)
    assert abs(down + up) < 1e-6 * abs(down) + 1e-3
