"""Rack, column spring, rack mount."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver.elements.steering import add_rack
from tests.solver.elements.mini import builder, number, stub, turned

PHI = [0.01, -0.02, 0.1]


def assembled(**topology: object):
    b = builder(**topology)
    frame = stub("sub-frame", [180.0, 0.0, 247.5], [0.5, 1.0, -0.5], PHI)
    b.bodies["rack"] = add_rack(b, frame, "RIB", "sub-frame")
    return b


def test_the_rack_slides_along_the_sub_frame_s_y() -> None:
    b = assembled()
    point = np.array([152.0, -350.0, 279.0])
    still = number(b, b.bodies["rack"].point(point))
    moved = number(b, b.bodies["rack"].point(point), {"rack": 12.0})
    # `rack` names both the pinion input and the travel: with both at 12 the column is at rest
    np.testing.assert_allclose(moved - still, 12.0 * turned(PHI)[:, 1])


def test_the_column_pulls_the_rack_to_the_pinion() -> None:
    b = assembled()
    travel, pinion = b.joints[-1].freedoms[0].symbol, b.controls["rack"]
    force = ca.substitute(
        ca.vertcat(b.points["column force"], b.resistances["rack"]),
        ca.vertcat(travel, pinion),
        ca.SX([3.0, 5.0]),
    )
    on_rack, resistance = number(b, force, {"scb.Tz": 1.5})
    assert on_rack == pytest.approx(1.5 * 2070.0 * 2.0)
    assert resistance == pytest.approx(-on_rack)


@pytest.mark.parametrize("windup", [-0.4, -0.02, 0.0, 0.1, 1.0])
def test_power_assist_adds_to_the_column_s_force(windup: float) -> None:
    b = assembled(power_assist=True)
    travel, pinion = b.joints[-1].freedoms[0].symbol, b.controls["rack"]
    expression = ca.substitute(b.resistances["rack"], ca.vertcat(travel, pinion), ca.SX([windup, 0.0]))
    found = number(b, expression, {"power_assist.gain": 1.5, "power_assist.reference": 300.0})
    column = 2070.0 * windup
    share = (column / 300.0) ** 2 / (1 + (column / 300.0) ** 2)
    assert found == pytest.approx(column * (1 + 1.5 * share))


def test_half_the_assistance_is_there_at_the_reference_force() -> None:
    b = assembled(power_assist=True)
    travel, pinion = b.joints[-1].freedoms[0].symbol, b.controls["rack"]
    at = ca.SX([300.0 / 2070.0, 0.0])
    expression = ca.substitute(b.resistances["rack"], ca.vertcat(travel, pinion), at)
    found = number(b, expression, {"power_assist.gain": 2.0, "power_assist.reference": 300.0})
    assert found == pytest.approx(600.0)


def test_a_rack_mount_carries_rack_and_pinion() -> None:
    b = assembled(rack_mount=True)
    assert [j.label for j in b.joints] == ["rack housing", "rack"]
    linear = {"rack_mount.rate": 6000.0, "rack_mount.stiffening": 0.0, "rack_mount.reference": 0.2}
    given = linear | {"rack housing": 0.4}
    assert number(b, b.resistances["rack housing"], given) == pytest.approx(2400.0)
    # q = (0.4 / 0.2)^2 = 4, so that four fifths of the stiffening are there
    stiffer = given | {"rack_mount.stiffening": 0.25}
    assert number(b, b.resistances["rack housing"], stiffer) == pytest.approx(2400.0 * 1.2)
    # the pinion rides on the housing: its motion winds nothing up
    assert number(b, b.points["column force"], given) == pytest.approx(0.0)
    still = number(b, b.bodies["rack"].origin, given | {"rack housing": 0.0})
    np.testing.assert_allclose(
        number(b, b.bodies["rack"].origin, given) - still, 0.4 * turned(PHI)[:, 1], atol=1e-12
    )
