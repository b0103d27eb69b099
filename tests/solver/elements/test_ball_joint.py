"""Ball joint: a body that turns about a point of another, and the probes against its turning."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver.elements.ball_joint import ball_body, turning_ball
from tests.solver.elements.mini import SIDES, builder, gibbs, hardpoint, number, stub, turned, wrench

PHI = [0.1, -0.2, 0.3]


@pytest.mark.parametrize("side", SIDES)
def test_a_body_hangs_on_the_ball_which_carries_no_moment(side: str) -> None:
    b, ball = builder(), hardpoint("LWB", side)
    arm = stub(f"arm {side}", hardpoint("LLF", side), [0.0, 1.0, 20.0], PHI)
    knuckle = ball_body(b, f"knuckle {side}", arm, ca.SX(ball))
    (joint,) = b.joints
    assert not joint.carries_moment and len(joint.freedoms) == 3
    at = hardpoint("LLF", side)
    np.testing.assert_allclose(number(b, knuckle.origin), at + [0.0, 1.0, 20.0] + turned(PHI) @ (ball - at))
    given = {f"knuckle {side}.{a}": v for a, v in zip(("rx", "ry", "rz"), gibbs([0, 0, 0.2]), strict=True)}
    np.testing.assert_allclose(number(b, knuckle.axes, given), turned([0, 0, 0.2]), atol=1e-12)


@pytest.mark.parametrize(("side", "sign"), [("L", 1.0), ("R", -1.0)])
def test_probes_turn_both_parts_against_each_other(side: str, sign: float) -> None:
    """1 Nm about the carrier's z, mirrored on the right."""
    b = builder(probes=True)
    arm, knuckle = stub("arm", rotation=PHI), stub("knuckle", rotation=PHI)
    turning_ball(b, "ball joint", arm, knuckle, side)
    names = [p.name for p, _, _ in b.probes]
    assert names == [f"ball joint {a} {side} force pair" for a in ("rx", "ry", "rz")]
    symbols = ca.vertcat(*[symbol for _, symbol, _ in b.probes])
    b.wrenches = {
        name: tuple(ca.substitute(part, symbols, ca.SX([0, 0, 1])) for part in parts)
        for name, parts in b.wrenches.items()
    }
    (_, on_arm), (_, on_knuckle) = wrench(b, "arm"), wrench(b, "knuckle")
    np.testing.assert_allclose(on_arm, sign * 1000.0 * turned(PHI)[:, 2], atol=1e-9)
    np.testing.assert_allclose(on_knuckle, -on_arm)


def test_without_probes_nothing_is_put_in() -> None:
    b = builder()
    turning_ball(b, "ball joint", stub("arm"), stub("knuckle"), "L")
    assert not b.wrenches and not b.probes
