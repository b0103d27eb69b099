"""The type that the documentation writes: it is read, solved, and moves as a trailing arm must."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.axle_file import read_axle
from doe_kc.axle_file.write import write_axle
from doe_kc.axle_types.read import FOLDER
from doe_kc.solver.suite import solve
from tests.reference import EXAMPLE
from tests.solver.tangent import Rig

PAGE = EXAMPLE.parents[1] / "docs" / "axle_types.md"
STIFF = "{ Fx = 1e7, Fy = 1e7, Fz = 1e7, Tx = 0.5, Ty = 0.5, Tz = 0.5 }"
AXLE = f"""
schema = "doe_kc.axle/1"
type = "trailing_arm.toml"
name = "Trailing arm"
units = {{ length = "mm", force = "N", angle = "deg", stiffness = "N/mm", rotational_stiffness = "Nm/deg" }}
static = {{ toe = 0.0, camber = 0.0 }}
tyre = {{ rate = 200.0, static_load = 3000.0 }}
spring = {{ rate = 30.0 }}
[hardpoints]
WLC = [0.0, -740.0, 300.0]
AOB = [-400.0, -600.0, 320.0]
AIB = [-400.0, -300.0, 320.0]
LWS = [-150.0, -500.0, 280.0]
UPS = [-150.0, -500.0, 500.0]
[bushings.aob]
stiffness = {STIFF}
[bushings.aib]
stiffness = {STIFF}
"""


@pytest.fixture(scope="module")
def trailing_arm(tmp_path_factory: pytest.TempPathFactory) -> Axle:
    folder: Path = tmp_path_factory.mktemp("type")
    (block,) = re.findall(r"```toml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    (folder / "trailing_arm.toml").write_text(block, encoding="utf-8")
    (folder / "axle.toml").write_text(AXLE, encoding="utf-8")
    return read_axle(folder / "axle.toml")


def test_the_wheel_centre_travels_on_a_circle_about_the_pivot_axis(trailing_arm: Axle) -> None:
    solution = solve(trailing_arm, ["vertical"], compiled=False)
    pivot, radius = np.array([-400.0, 320.0]), np.hypot(400.0, 20.0)
    for branch in solution.cases["vertical"].branches:
        x, y, z = (branch.y[:, solution.column(f"wc_{axis}@L")] for axis in "xyz")
        assert np.hypot(x - pivot[0], z - pivot[1]) == pytest.approx(radius, abs=2e-3)
        assert y == pytest.approx(-740.0, abs=2e-3)
        wound = np.radians(branch.y[:, solution.column("spin@L")])
        turned = np.arctan2(z - pivot[1], x - pivot[0]) - np.arctan2(-20.0, 400.0)
        assert wound == pytest.approx(-turned, abs=1e-5)


def test_toe_and_camber_stay_as_the_axis_is_across_the_car(trailing_arm: Axle) -> None:
    solution = solve(trailing_arm, ["vertical"], compiled=False)
    for branch in solution.cases["vertical"].branches:
        for name in ("toe", "camber"):
            assert branch.y[:, solution.column(f"{name}@L")] == pytest.approx(0.0, abs=2e-3)


def test_it_is_written_back_into_another_folder(trailing_arm: Axle, tmp_path: Path) -> None:
    folder = tmp_path / "own"
    folder.mkdir()
    (block,) = re.findall(r"```toml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    (folder / "trailing_arm.toml").write_text(block, encoding="utf-8")
    (folder / "axle.toml").write_text(AXLE, encoding="utf-8")
    changed = with_values(trailing_arm, {"AOB.x": -398.5, "aib.Fx": 0.75, "right.LWS.z": 281.0})
    written = write_axle(changed, folder / "axle.toml", tmp_path / "out" / "deep" / "axle.toml")
    assert read_axle(written).values == changed.values


def test_a_double_wishbone_with_its_spring_on_the_upper_arm_is_a_changed_file(tmp_path: Path) -> None:
    """No Python: the spring's lower end is named on another body. It carries the wheel at another rate, and
    the axle stores energy: what a pad does to the other wheel's load, that pad does to this one's."""
    shipped = (FOLDER / "double_wishbone_front.toml").read_text(encoding="utf-8")
    spring = 'at_a = "UPS"\nb = "lower_arm"\nat_b = "LWS"\n\n[damper]'
    assert spring in shipped
    own = shipped.replace(spring, 'at_a = "UPS"\nb = "upper_arm"\nat_b = "SPU"\n\n[damper]')
    own = own.replace('LWS = "', 'SPU = "Spring on the upper arm"\nLWS = "')
    (tmp_path / "own.toml").write_text(own, encoding="utf-8")
    example = EXAMPLE.parent / "double_wishbone_front" / "axle.toml"
    axle_text = example.read_text(encoding="utf-8").replace(
        'type = "double_wishbone_front"', 'type = "own.toml"'
    )
    axle_text = axle_text.replace("[hardpoints]\n", "[hardpoints]\nSPU = [22.0, -600.0, 632.0]\n")
    (tmp_path / "axle.toml").write_text(axle_text, encoding="utf-8")
    lower, upper = read_axle(example), read_axle(tmp_path / "axle.toml")
    rates = []
    for axle in (lower, upper):
        rig = Rig(axle)
        inputs, outputs = ("pad_L", "pad_R", "rack"), ("tyre_load@L", "tyre_load@R", "column_force")
        hessian = rig.tangent(rig.static.x, rig.static.u, outputs, inputs)
        np.testing.assert_allclose(hessian, hessian.T, rtol=0, atol=1e-9 * np.abs(hessian).max())
        rates.append(hessian[0, 0])
        loads = [rig.static.y[rig.kernel.layout.output_names.index(f"tyre_load@{side}")] for side in "LR"]
        assert loads == pytest.approx([axle.values["tyre.static_load"]] * 2, rel=1e-9)
    assert abs(rates[1] - rates[0]) > 1.0


def test_a_spring_by_another_name_is_written_back(tmp_path: Path) -> None:
    shipped = (FOLDER / "rigid_rear.toml").read_text(encoding="utf-8")
    assert "[springs.spring]" in shipped
    (tmp_path / "own.toml").write_text(
        shipped.replace("[springs.spring]", "[springs.coil]"), encoding="utf-8"
    )
    text = (EXAMPLE.parent / "rigid_rear" / "axle.toml").read_text(encoding="utf-8")
    text = text.replace('type = "rigid_rear"', 'type = "own.toml"').replace("[spring]", "[coil]")
    (tmp_path / "axle.toml").write_text(text, encoding="utf-8")
    axle = with_values(read_axle(tmp_path / "axle.toml"), {"coil.rate": 31.5, "right.coil.rate": 33.0})
    again = read_axle(write_axle(axle, tmp_path / "axle.toml", tmp_path / "new.toml"))
    assert dict(again.values) == dict(axle.values)
