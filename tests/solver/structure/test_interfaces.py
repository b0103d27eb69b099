"""Probes of axles whose type is data: columns of laws against the full model with a small effect."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest

from doe_kc.axle import Axle
from doe_kc.curves import RESPONSE_UNITS, CurveSet
from doe_kc.effects import apply_effect
from doe_kc.effects.subframe_flexibility import JOINT_STIFFNESS
from doe_kc.solver.assembly import assemble
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.elements.wheel import SPIN_STIFFNESS
from doe_kc.solver.interface_columns import law_columns
from doe_kc.solver.interfaces import Influences, interface_influences
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.probe import Probe
from doe_kc.solver.suite import solve
from tests.axle_type_reference import TYPES, nominal
from tests.reference import steps_only

SMALL = 1e-3
TIGHT = NewtonSettings(tol=1e-8)
CASES = ("vertical", "lateral", "brake")
SCALE = {"deg": 0.01, "mm": 0.1, "N": 10.0}
SPIN = np.degrees(1000.0 / SPIN_STIFFNESS)
"""deg/Nm of the hub's brake lock, which is not quite rigid."""


@lru_cache
def short(axle_type: str) -> Axle:
    axle = nominal(axle_type)
    cases = {i: replace(axle.load_cases[i], steps=4) for i in CASES}
    return replace(axle, load_cases=cases)


def solved(axle: Axle) -> CurveSet:
    return steps_only(curve_set(solve(axle, lanes=True, settings=TIGHT)), axle)


@lru_cache
def before(axle_type: str) -> CurveSet:
    return solved(short(axle_type))


@lru_cache
def influences(axle_type: str) -> Influences:
    axle = short(axle_type)
    return interface_influences(axle, solve(axle, lanes=True, settings=TIGHT))


def series(interface: str, sides: tuple[str, ...] = ("L", "R"), **compliance: float) -> dict[str, float]:
    return {
        Probe(interface, dof, "dislocation", side, "mm").name: value
        for dof, value in compliance.items()
        for side in sides
    }


BALL = dict.fromkeys("xyz", SMALL / 12000.0)
HALVES = {k.removeprefix("k"): SMALL / v for k, v in JOINT_STIFFNESS.items()}
HUB = {"rx": SMALL / 6000, "rz": SMALL / 9000, "ry": SPIN}
SOFT_BALL = {"k_N_mm": 12000.0 / SMALL}
FRICTION = {f"damper along {side} force pair": 0.1 for side in "LR"}
SOFT_HUB = {"camber_Nm_deg": 6000.0 / SMALL, "toe_Nm_deg": 9000.0 / SMALL}
CHECKS: list[tuple[str, str, dict[str, Any], str, dict[str, float]]] = [
    ("five_link_rear", "ball_compliance", {"joints": ["TLO_L", "TLO_R"], **SOFT_BALL}, "compliance",
     series("tlo|knuckle", **BALL)),
    ("five_link_rear", "ball_compliance", {"joints": ["UFO_L"], **SOFT_BALL}, "compliance",
     series("ufo|upper front", ("L",), **BALL)),
    ("five_link_rear", "subframe_flexibility", {"scale": 1.0 / SMALL}, "compliance",
     series("sub-frame half|centre", **HALVES)),
    ("five_link_rear", "damper_friction", {"force_N": 0.1}, "friction", FRICTION),
    ("double_wishbone_front", "ball_compliance", {"joints": ["UBJ_L", "UBJ_R"], **SOFT_BALL}, "compliance",
     series("ubj|knuckle", **BALL)),
    ("double_wishbone_front", "ball_compliance", {"joints": ["LBJ_L", "LBJ_R"], **SOFT_BALL}, "compliance",
     series("lbj|lower arm", **BALL)),
    ("double_wishbone_front", "tie_rod_compliance", {"k_N_mm": 15000.0 / SMALL}, "compliance",
     series("tie rod", along=SMALL / 15000.0)),
    ("double_wishbone_front", "rack_mount_compliance", {"k_N_mm": 6000.0 / SMALL}, "compliance",
     series("rack housing|sub-frame", ("",), y=SMALL / 6000.0)),
    ("semi_trailing_rear", "hub_compliance", SOFT_HUB, "compliance", series("wheel|arm", **HUB)),
    ("twist_beam_rear", "damper_friction", {"force_N": 0.1}, "friction", FRICTION),
    ("rigid_rear", "ball_compliance", {"joints": ["PHA"], **SOFT_BALL}, "compliance",
     series("pha|axle", ("",), **BALL)),
]  # fmt: skip


@pytest.mark.parametrize(
    ("axle_type", "effect", "options", "law", "weights"), CHECKS, ids=[f"{t}-{e}" for t, e, *_ in CHECKS]
)
def test_a_column_is_what_the_effect_does(
    axle_type: str, effect: str, options: dict[str, Any], law: str, weights: dict[str, float]
) -> None:
    """Means and half-widths, relative RMS; friction opens loops, so that only they tell of it."""
    changed = solved(apply_effect(short(axle_type), effect, options, source="test"))
    columns = law_columns(influences(axle_type), law, 0.3)
    amplitudes = np.array([weights.get(path, 0.0) for path in columns.paths])
    assert np.count_nonzero(amplitudes) == len(weights)
    gap = size = 0.0
    part = "half_width" if law == "friction" else "mean"
    predicted = columns.half_width if law == "friction" else columns.cases
    for ident, responses in predicted.items():
        for response, unit in RESPONSE_UNITS.items():
            new, old = (getattr(c.cases[ident], part)[response] for c in (changed, before(axle_type)))
            true, said = (new - old) / SCALE[unit], responses[response] @ amplitudes / SCALE[unit]
            gap, size = gap + float(np.sum((true - said) ** 2)), size + float(np.sum(true**2))
    assert size > 0.0
    assert np.sqrt(gap / size) < 5e-3


@pytest.mark.parametrize("axle_type", TYPES)
def test_probes_add_nothing_to_the_axle_and_are_at_all_its_joints(axle_type: str) -> None:
    topology = nominal(axle_type).topology
    plain, probed = assemble(topology), assemble(replace(topology, probes=True))
    assert plain.unknowns == probed.unknowns and not plain.probes
    names = [p.name for p in probed.probes]
    assert len(set(names)) == len(names)
    interfaces = {p.interface for p in probed.probes}
    structure = topology.structure
    assert {bush.name for bush in structure.bushings} <= interfaces
    for joint in structure.balls:
        assert joint.name in interfaces and any(i.startswith(f"{joint.name}|") for i in interfaces)
    assert {rod.name.replace("_", " ") for rod in structure.rods} <= interfaces
    assert f"wheel|{structure.carrier}" in interfaces
    assert ("drop link" in interfaces) == (structure.bar is not None)
    assert ("column" in interfaces) == (structure.rack is not None)
    for side in "LR":
        assert [replace(p, side="L") for p in probed.probes if p.side == side] == [
            p for p in probed.probes if p.side == "L"
        ]


@pytest.mark.parametrize("axle_type", ["double_wishbone_front", "five_link_rear"])
def test_what_a_symmetric_axle_shows_is_symmetric(axle_type: str) -> None:
    found = influences(axle_type)
    at = {p.name: i for i, p in enumerate(found.probes)}
    for p, value in zip(found.probes, found.static.seen, strict=True):
        if p.side == "L":
            other = found.static.seen[at[replace(p, side="R").name]]
            assert other == pytest.approx(value, rel=1e-6, abs=1e-6), p.name
