"""Bodies of a structure along its tree: strut rod, rigid and sprung parts, of the McPherson axle."""

from __future__ import annotations

import numpy as np
import pytest

from tests.solver.elements.mini import SIDES, gibbs, hardpoint, number, turned, whole, wrench

SHIFT, PHI = np.array([3.0, -5.0, 12.0]), [0.02, 0.01, -0.2]
POSE = {f"lower arm L.{a}": v for a, v in zip("xyz", SHIFT, strict=True)} | {
    f"knuckle L.r{a}": v for a, v in zip("xyz", gibbs(PHI), strict=True)
}


def axis() -> np.ndarray:
    along = hardpoint("UPB") - hardpoint("LWD")
    return along / np.linalg.norm(along)


def test_the_rod_slides_and_twists_along_the_axis_of_the_tube() -> None:
    b, given = whole(), POSE | {"strut slide L": -25.0, "strut twist L": float(np.tan(0.05))}
    r, ball = turned(PHI), hardpoint("LWB")
    top = ball + SHIFT + r @ (hardpoint("UPB") - ball)
    rod = b.bodies["rod.L"]
    np.testing.assert_allclose(number(b, rod.origin, given), top - 25.0 * r @ axis())
    np.testing.assert_allclose(number(b, rod.axes, given), r @ turned(0.1 * axis()), atol=1e-12)


def test_the_slide_is_the_change_of_the_length_from_damper_to_top_mount() -> None:
    b, given = whole(), POSE | {"strut slide L": 31.0}
    tube, rod = b.bodies["tube.L"], b.bodies["rod.L"]
    damper = number(b, tube.point(np.array(hardpoint("LWD"))), given)
    length = np.linalg.norm(number(b, rod.origin, given) - damper)
    assert length == pytest.approx(np.linalg.norm(hardpoint("UPB") - hardpoint("LWD")) + 31.0)


def test_the_top_mount_pulls_the_rod_back_to_the_body() -> None:
    force, _ = wrench(whole(), "rod L", {"strut slide L": 2.0})
    np.testing.assert_allclose(force, -np.array([3000.0, 3000.0, 1200.0]) * 2.0 * axis())


def test_the_arm_has_six_freedoms_and_its_origin_in_the_ball_joint() -> None:
    b = whole()
    joint = next(j for j in b.joints if j.label == "lower arm L")
    assert len(joint.freedoms) == 6 and joint.parent is None
    np.testing.assert_allclose(number(b, b.bodies["lower_arm.L"].design), hardpoint("LWB"))


@pytest.mark.parametrize(
    ("part", "carrier", "flags"),
    [
        ("tube", "knuckle", {"strut_bending": True}),
        ("steer_arm", "knuckle", {"steer_arm": True}),
        ("subframe.{}", "subframe", {"flexible_subframe": True}),
    ],
)
def test_a_rigid_part_is_its_carrier_until_it_gives_way(
    part: str, carrier: str, flags: dict[str, bool]
) -> None:
    rigid, elastic = whole(), whole(**flags)
    for side in SIDES:
        name = part.format(side) if "{" in part else f"{part}.{side}"
        host = carrier if carrier in rigid.bodies else f"{carrier}.{side}"
        assert rigid.bodies[name] is rigid.bodies[host]
        assert elastic.bodies[name] is not elastic.bodies[host]
