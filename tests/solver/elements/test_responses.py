"""Outputs read off a solved axle, against the geometry of the design position and of a second reader."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.solver.elements.responses import AXLE_OUTPUT_UNITS, OUTPUT_UNITS
from doe_kc.solver.kernel import kernel
from tests.reference import nominal
from tests.solver.elements.mini import hardpoint

K = kernel(nominal().topology)


def at_design() -> dict[str, float]:
    """Outputs with all bodies in their design place."""
    x = np.zeros(K.nx)
    u = np.zeros(K.nu)
    c = K.constant_values(dict(nominal().values))
    y = np.asarray(K.functions["outputs"](x, c, u, np.zeros(K.nz))).ravel()
    return dict(zip(K.layout.output_names, y, strict=True))


def test_every_output_has_a_unit_and_every_unit_an_output() -> None:
    expected = [f"{n}@{s}" for s in ("L", "R") for n in OUTPUT_UNITS] + list(AXLE_OUTPUT_UNITS)
    assert sorted(K.layout.output_names) == sorted(expected)
    assert set(OUTPUT_UNITS.values()) | set(AXLE_OUTPUT_UNITS.values()) <= {"deg", "mm", "N"}


@pytest.mark.parametrize("side", ["L", "R"])
def test_design_angles_and_positions(side: str) -> None:
    y = at_design()
    kingpin = hardpoint("UPB") - hardpoint("LWB")
    assert y[f"toe@{side}"] == pytest.approx(0.05)
    assert y[f"camber@{side}"] == pytest.approx(-0.5)
    assert y[f"camber_ground@{side}"] == pytest.approx(-0.5)
    assert y[f"caster@{side}"] == pytest.approx(np.degrees(np.arctan2(kingpin[0], kingpin[2])))
    assert y[f"spin@{side}"] == pytest.approx(y[f"caster@{side}"])
    assert y[f"kpi@{side}"] == pytest.approx(np.degrees(np.arctan2(kingpin[1], kingpin[2])))
    for i, a in enumerate("xyz"):
        assert y[f"wc_{a}@{side}"] == pytest.approx(hardpoint("WLC", side)[i])
    assert y[f"cp_z@{side}"] == pytest.approx(0.0, abs=1e-9)
    assert y[f"tyre_load@{side}"] == pytest.approx(4300.0)
    assert y[f"strut_compression@{side}"] == 0.0


def test_scrub_radius_and_trail_are_where_the_kingpin_meets_the_ground() -> None:
    y = at_design()
    lower, upper = hardpoint("LWB"), hardpoint("UPB")
    foot = lower + (upper - lower) * (0.0 - lower[2]) / (upper - lower)[2]
    contact = np.array([y[f"cp_{a}@L"] for a in "xyz"])
    # + when the kingpin meets the ground inside the contact point
    assert y["scrub_radius@L"] == pytest.approx(foot[1] - contact[1])
    assert y["scrub_radius@R"] == pytest.approx(y["scrub_radius@L"])
    assert y["caster_trail@L"] == pytest.approx(contact[0] - foot[0])
    assert y["caster_trail@L"] > 0
