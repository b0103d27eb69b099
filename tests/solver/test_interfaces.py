"""Columns of laws at interfaces against the full model with the effect at a thousandth of typical size."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from doe_kc.axle import Axle, with_values
from doe_kc.curves import ANGLES, RESPONSE_UNITS, CurveSet
from doe_kc.effects import apply_effect
from doe_kc.effects.subframe_flexibility import JOINT_STIFFNESS
from doe_kc.solver.assembly import assemble
from doe_kc.solver.curve_gradient import CurveGradients
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.elements.wheel import SPIN_STIFFNESS
from doe_kc.solver.interface_columns import LAWS, law_columns, stop_operator
from doe_kc.solver.interfaces import Influences, interface_influences
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.probe import Probe
from doe_kc.solver.suite import solve
from tests.reference import nominal, step_rows

SMALL = 1e-3
TIGHT = NewtonSettings(tol=1e-8)
SCALE = {"deg": 0.01, "mm": 0.1, "N": 10.0}
Weights = Mapping[str, float]


def with_effects(*effects: tuple[str, dict[str, object]], base: Axle | None = None) -> Axle:
    axle = short() if base is None else base
    for ident, options in effects:
        axle = apply_effect(axle, ident, options, source="test")
    return axle


@lru_cache
def short() -> Axle:
    cases = {i: replace(c, steps=max(4, c.steps // 4)) for i, c in nominal().load_cases.items()}
    return replace(nominal(), load_cases=cases)


@lru_cache
def base(name: str) -> Axle:
    return {
        "plain": short,
        "raised": lambda: with_values(short(), {"ride_height": 12.0, "right.llr.Fx": 1.4}),
        "compliant": lambda: with_effects(
            *[(i, {}) for i in ("hub_compliance", "strut_bending", "subframe_flexibility")],
            *[(i, {}) for i in ("rack_mount_compliance", "power_assist")],
        ),
        "yielding joints": lambda: with_effects(
            *[(i, {}) for i in ("ball_joint_compliance", "steer_arm_compliance")],
            ("tyre_horizontal_compliance", {}),
        ),
        "dahl": lambda: with_effects(("steering_friction", {}), ("hub_compliance", {})),
        "iwan": lambda: with_effects(("strut_friction", {"law": "iwan"})),
    }[name]()


@lru_cache
def curves(name: str) -> CurveSet:
    return solved(base(name))


def solved(axle: Axle) -> CurveSet:
    return curve_set(solve(axle, lanes=True, settings=TIGHT))


@lru_cache
def influences(name: str) -> Influences:
    return interface_influences(base(name), solve(base(name), lanes=True, settings=TIGHT))


def both_sides(interface: str, kind: str, amplitude: float) -> dict[str, float]:
    return {f"{interface} {side} {kind}": amplitude for side in "LR"}


def series(interface: str, **compliance: float) -> dict[str, float]:
    out: dict[str, float] = {}
    for dof, value in compliance.items():
        out |= both_sides(f"{interface} {dof}", "dislocation", value)
    return out


def weighted(columns: CurveGradients, weights: Weights) -> np.ndarray:
    out = np.array([weights.get(path, 0.0) for path in columns.paths])
    assert np.count_nonzero(out) == len(weights)
    return out


def misses(
    name: str,
    changed: CurveSet,
    law: str,
    weights: Weights,
    presliding: float = 0.05,
    static: float = 2e-3,
) -> list[float]:
    """Relative RMS errors of the predicted change: of the mean curves, of the half-widths."""
    before, columns = curves(name), law_columns(influences(name), law, presliding)
    amplitudes, out = weighted(columns, weights), []
    inputs = *({i: c.input for i, c in x.cases.items()} for x in (changed, before)), columns.inputs
    for part, predicted in (("mean", columns.cases), ("half_width", columns.half_width)):
        gap = size = 0.0
        for ident in predicted:
            rows = [step_rows(i[ident], base(name).load_cases[ident]) for i in inputs]
            for response, unit in RESPONSE_UNITS.items():
                lines = [getattr(c.cases[ident], part)[response] for c in (changed, before)]
                lines.append(predicted[ident][response] @ amplitudes)
                new, old, said = (line[:, at] / SCALE[unit] for line, at in zip(lines, rows, strict=True))
                true = new - old
                gap, size = gap + float(np.sum((true - said) ** 2)), size + float(np.sum(true**2))
        out.append(np.sqrt(gap / size) if size else 0.0)
    assert before.static is not None and changed.static is not None
    for angle in ANGLES:
        gap_static = changed.static[angle] - before.static[angle] - columns.static[angle] @ amplitudes
        assert np.abs(gap_static).max() < 1e-8 + static * np.abs(columns.static[angle] @ amplitudes).max()
    return out


SPIN = np.degrees(1000.0 / SPIN_STIFFNESS)
"""deg/Nm of the hub's brake lock, which is not quite rigid."""
HALVES = {k.removeprefix("k"): SMALL / v for k, v in JOINT_STIFFNESS.items()}
SERIES = {
    "hub_compliance": (
        {"camber_Nm_deg": 6000.0 / SMALL, "toe_Nm_deg": 9000.0 / SMALL},
        series("wheel|knuckle", rx=SMALL / 6000, rz=SMALL / 9000, ry=SPIN),
    ),
    "strut_bending": (
        {"k_Nm_deg": 8000.0 / SMALL, "torsion_Nm_deg": 30000.0 / SMALL},
        series("tube|knuckle", rx=SMALL / 8000, ry=SMALL / 8000, rz=SMALL / 30000),
    ),
    "rack_mount_compliance": (
        {"k_N_mm": 6000.0 / SMALL},
        {"rack housing|sub-frame y dislocation": SMALL / 6000},
    ),
    "subframe_flexibility": ({"scale": 1.0 / SMALL}, series("sub-frame half|centre", **HALVES)),
    "tyre_horizontal_compliance": (
        {"k_lat_N_mm": 180.0 / SMALL, "k_long_N_mm": 250.0 / SMALL},
        series("contact patch|wheel", y=SMALL / 180, x=SMALL / 250),
    ),
    "ball_joint_compliance": (
        {"k_N_mm": 12000.0 / SMALL},
        series("ball joint|arm", **dict.fromkeys("xyz", SMALL / 12000)),
    ),
    "tie_rod_compliance": ({"k_N_mm": 15000.0 / SMALL}, series("tie rod", along=SMALL / 15000)),
    "anti_roll_bar_link_compliance": ({"k_N_mm": 300.0 / SMALL}, series("drop link", z=SMALL / 300)),
}
HAS = {
    "compliant": ("hub_compliance", "strut_bending", "rack_mount_compliance", "subframe_flexibility"),
    "yielding joints": ("ball_joint_compliance", "tyre_horizontal_compliance"),
    "dahl": ("hub_compliance",),
}
CHECKS = [
    (b, e)
    for b in ("plain", "raised", "compliant", "yielding joints")
    for e in SERIES
    if e not in HAS.get(b, ())
]
LOOPS = [(b, e) for b in ("dahl", "iwan") for e in ("tie_rod_compliance", "ball_joint_compliance")]


@pytest.mark.parametrize(("name", "effect"), CHECKS + LOOPS)
def test_compliance_in_series(name: str, effect: str) -> None:
    options, weights = SERIES[effect]
    changed = solved(with_effects((effect, options), base=base(name)))
    assert max(misses(name, changed, "compliance", weights)) < 2e-3


def test_a_softer_column() -> None:
    weights = {"column along dislocation": SMALL / 2070.0}
    for name in ("plain", "compliant"):
        changed = solved(with_values(base(name), {"scb.Tz": 1 / (1 + SMALL)}))
        assert max(misses(name, changed, "compliance", weights)) < 1e-4


def test_a_tower_that_gives_way_is_a_softer_top_mount() -> None:
    """Springs in series: the bushing's factor is 1 / (1 + k C)."""
    k = base("plain").values["upb.stiffness.Fx@L"]
    changed = solved(with_values(base("plain"), {"upb.Fx": 1 / (1 + SMALL)}))
    assert max(misses("plain", changed, "compliance", series("upb|body", x=SMALL / k))) < 2e-3


@pytest.mark.parametrize("name", ["plain", "raised", "compliant", "dahl"])
def test_laws_of_force_pairs(name: str) -> None:
    axle, b = base(name), 0.05 * SMALL
    v = axle.values
    twist = {f"{n}.T{a}": SMALL * v[f"{n}.stiffness.T{a}@L"] for n, a in (("llf", "x"), ("upb", "z"))}
    checks: list[tuple[str, dict[str, float], Weights]] = [
        ("progression", {"llf.cubic.Fx": v["llf.cubic.Fx@L"] + b},
         both_sides("llf x", "force pair", b * v["llf.stiffness.Fx@L"])),
        ("progression", {"upb.cubic.Fy": v["upb.cubic.Fy@L"] + b},
         both_sides("upb y", "force pair", b * v["upb.stiffness.Fy@L"])),
        ("offset", {"llr.preload.Fy": 600 * SMALL}, both_sides("llr y", "force pair", 600 * SMALL)),
        ("offset", {"right.upb.preload.Fy": 0.6}, {"upb y R force pair": 0.6}),
        ("offset", {"damper.gas_force": 0.1}, both_sides("rod|tube z", "force pair", -0.1)),
        ("stiffness", {"llf.Tx": 1 + SMALL}, both_sides("llf rx", "force pair", twist["llf.Tx"])),
        ("stiffness", {"upb.Tz": 1 + SMALL}, both_sides("upb rz", "force pair", twist["upb.Tz"])),
    ]  # fmt: skip
    for law, values, weights in checks:
        found = misses(name, solved(with_values(axle, values)), law, weights)
        assert found[0] < 1e-3 and found[1] < 5e-3, (law, values, found)


@pytest.mark.parametrize(
    ("name", "effect", "options", "weights", "presliding"),
    [
        ("plain", "steering_friction", {"force_N": 0.1}, {"rack|housing along force pair": 0.1}, 0.05),
        ("plain", "strut_friction", {"force_N": 0.1}, both_sides("rod|tube z", "force pair", 0.1), 0.3),
        ("dahl", "strut_friction", {"force_N": 0.1}, both_sides("rod|tube z", "force pair", 0.1), 0.3),
        ("dahl", "steering_friction", {"force_N": 250.1}, {"rack|housing along force pair": 0.1}, 0.05),
    ],
)
def test_friction_opens_loops(
    name: str, effect: str, options: dict[str, object], weights: Weights, presliding: float
) -> None:
    changed = solved(with_effects((effect, options), base=base(name)))
    assert max(misses(name, changed, "friction", weights, presliding)) < 2e-3


def test_play_of_a_tie_rod_end() -> None:
    """The corner of the sign is not the joint's: the same picture, not the same figures."""
    changed = solved(
        with_effects(("tie_rod_free_play", {"gap_mm": 0.02, "contact_N_mm": 2e7}), base=base("plain"))
    )
    weights = both_sides("tie rod along", "dislocation", 0.01)
    assert misses("plain", changed, "clearance", weights, static=0.05)[0] < 0.05


@pytest.mark.parametrize("name", ["plain", "compliant", "yielding joints", "dahl", "iwan"])
def test_probes_add_no_unknowns_and_nothing_to_the_axle_without_them(name: str) -> None:
    topology = base(name).topology
    plain, probed = assemble(topology), assemble(replace(topology, probes=True))
    assert plain.unknowns == probed.unknowns
    assert plain.probes == () and plain.e.numel() == plain.seen.numel() == 0
    assert len(probed.probes) == probed.e.numel() == probed.seen.numel()
    assert not topology.probes


def test_probes_have_names_units_and_mirror_images() -> None:
    probes = assemble(replace(nominal().topology, probes=True)).probes
    names = [p.name for p in probes]
    assert len(set(names)) == len(names) > 150
    sides = {side: [p for p in probes if p.side == side] for side in ("L", "R", "")}
    assert [replace(p, side="R") for p in sides["L"]] == sides["R"]
    assert {p.interface for p in sides[""]} == {"rack housing|sub-frame", "column", "rack|housing"}
    for p in probes:
        assert (p.unit in {"deg", "Nm"}) == (p.dof in {"rx", "ry", "rz"})
        assert (p.unit in {"deg", "mm"}) == (p.kind == "dislocation")
    hub = Probe("wheel|knuckle", "rx", "dislocation", "L", "deg")
    assert hub in probes and LAWS["compliance"].amplitude_unit(hub) == "deg/Nm"
    pair = Probe("llf", "x", "force pair", "R", "N")
    assert pair in probes and LAWS["progression"].amplitude_unit(pair) == "N/mm^3"


def test_a_symmetric_axle_is_seen_as_symmetric() -> None:
    """What a probe shows at rest is the same on both sides, rotations and moments too."""
    found = influences("plain")
    at = {p.name: i for i, p in enumerate(found.probes)}
    for p, value in zip(found.probes, found.static.seen, strict=True):
        if p.side == "L":
            other = found.static.seen[at[replace(p, side="R").name]]
            assert other == pytest.approx(value, rel=1e-6, abs=1e-6), p.name


def test_what_probes_show_is_the_axle_s_own() -> None:
    found = influences("plain")
    s = found.solution
    names = [p.name for p in found.probes]
    branch, shown = s.cases["lateral"].branches[0], found.branches["lateral"][0].seen
    for probe, output, sign in (
        ("tie rod along L dislocation", "tie_rod@L", 1.0),
        ("tie rod along R dislocation", "tie_rod@R", 1.0),
        ("rod|tube z L force pair", "strut_compression@L", -1.0),
        ("rack|housing along force pair", "rack_travel", 1.0),
        ("column along dislocation", "column_force", -1.0),
    ):
        expected = sign * branch.y[:, s.column(output)]
        np.testing.assert_allclose(shown[:, names.index(probe)], expected, rtol=1e-9, atol=1e-9)
    load = shown[:, names.index("wheel|knuckle z L dislocation")]
    vertical = branch.y[:, s.column("tyre_load@L")]
    np.testing.assert_allclose(load, vertical, rtol=2e-3)  # in the knuckle's axes, which lean a little


def test_influences_need_a_static_state() -> None:
    with pytest.raises(ValueError, match="static state"):
        interface_influences(short(), replace(influences("plain").solution, static=None))


def test_the_stop_operator() -> None:
    around = np.linspace(0.0, 2.0, 41)[:, None]
    up, down, again = stop_operator([around, around[::-1], around], np.array([0.1]))
    np.testing.assert_allclose(up[:, 0], 1 - np.exp(-around[:, 0] / 0.1))
    np.testing.assert_allclose(down[:, 0], -1 + 2 * np.exp(-(2 - around[::-1, 0]) / 0.1), atol=1e-8)
    np.testing.assert_allclose(again[-1], [1.0], atol=1e-8)
    # however finely the way is divided
    coarse = stop_operator([around[::20], around[::-20]], np.array([0.1]))
    np.testing.assert_allclose(coarse[1], down[::20], atol=1e-12)
