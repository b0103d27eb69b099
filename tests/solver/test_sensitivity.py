"""Exact sensitivities against central differences, friction-free and along frictional loops."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from scipy import sparse

from doe_kc.axle import Axle, design_parameters, parameter_value, with_values
from doe_kc.axle.parameters import settable_paths
from doe_kc.axle_file import read_axle
from doe_kc.characteristics import CHARACTERISTICS, reduce_all
from doe_kc.effects import apply_effect
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.solver import sensitivity
from doe_kc.solver.curve_gradient import characteristic_gradients
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.derivatives import (
    CompiledDerivatives,
    InterpretedDerivatives,
    StateSequence,
    derivatives_of,
)
from doe_kc.solver.elements.responses import AXLE_OUTPUT_UNITS, OUTPUT_UNITS
from doe_kc.solver.kernel import kernel
from doe_kc.solver.library import find_compiler
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.result import Solution
from doe_kc.solver.sensitivity import Sensitivities, sensitivities
from doe_kc.solver.suite import solve
from tests.reference import nominal

ROUNDING = 1e-11
"""In an output's unit by a parameter's. Both ways sum the same terms, each in its own order; a sub-frame's
bushing moved up or down leaves a millionth of them (see test_differentiation for the rounding of each)."""
TIGHT = NewtonSettings(tol=1e-8)
"""Central differences of equilibria at the usual 1e-7 N would be noise at 1e-5 relative."""
SHORT = {"vertical": 8, "roll": 6, "lateral": 5, "lateral_offset": 5, "brake": 5, "drive": 5, "steer": 8}
ROUND_OFF = {"N": 5e-7, "mm": 1e-9, "deg": 1e-9}
"""Scatter of outputs between equilibria converged to TIGHT; over the step it bounds what differences tell."""


def short(axle: Axle) -> Axle:
    """Fewer steps: each is as good a check as the next."""
    cases = {i: replace(axle.load_cases[i], steps=n) for i, n in SHORT.items()}
    return replace(axle, load_cases=cases)


def tight(axle: Axle) -> Solution:
    return solve(axle, lanes=True, settings=TIGHT)


def step_of(axle: Axle, path: str) -> float:
    """Wide enough to drown rounding; Richardson's extrapolation takes care of the rest."""
    if path == INPUT_GAIN:
        return 2e-5  # at 1e-4 a loop with friction is marched in other steps
    if path == "tie_rod.gap":
        return 1e-4
    if path == "tie_rod.flexibility":
        return 1e-6
    value = abs(parameter_value(axle, path))
    if path.endswith((".x", ".y", ".z", ".clearance")) or path == "ride_height":
        return 0.03
    return 4e-3 if value == 0.0 or path.startswith("static.") else 4e-3 * value


def output_units(names: tuple[str, ...]) -> list[str]:
    units = OUTPUT_UNITS | AXLE_OUTPUT_UNITS
    return [units[name.split("@")[0]] for name in names]


INPUT_GAIN = "input gain"
"""Name of the column of the gain, which no path of an axle has."""


def moved(axle: Axle, path: str, change: float) -> Axle:
    """The axle with a path, or the gain of the input of every load case, changed."""
    if path != INPUT_GAIN:
        return with_values(axle, {path: parameter_value(axle, path) + change})
    return replace(axle, load_cases={i: replace(c, gain=c.gain + change) for i, c in axle.load_cases.items()})


def differences(axle: Axle, path: str, h: float) -> dict[tuple[str, int], np.ndarray]:
    up, down = (tight(moved(axle, path, sign * h)) for sign in (1, -1))
    return {
        (case, i): (up.cases[case].branches[i].y - branch.y) / (2 * h)
        for case, solved in down.cases.items()
        for i, branch in enumerate(solved.branches)
    }


def worst(axle: Axle, exact: Sensitivities, path: str) -> tuple[float, str]:
    """Largest relative difference over all equilibria and outputs, beyond what rounding explains."""
    h, column = step_of(axle, path), exact.paths.index(path)
    near, far = differences(axle, path, h), differences(axle, path, 2 * h)
    names = kernel(axle.topology).layout.output_names
    floor = np.array([ROUND_OFF[unit] for unit in output_units(names)]) / h
    found = (0.0, "")
    for case, branches in exact.branches.items():
        for i, derivative in enumerate(branches):
            mine = derivative[:, :, column]
            gap = np.abs((4 * near[case, i] - far[case, i]) / 3 - mine).max(axis=0)
            ratio = np.maximum(gap - floor, 0.0) / np.maximum(np.abs(mine).max(axis=0), 1e-9)
            found = max(found, (float(ratio.max()), f"{case} {i} {names[int(ratio.argmax())]}"))
    return found


FREE_PATHS = (
    "LLF.z", "LLR.y", "LWB.x", "LWD.y", "LWS.z", "UPB.x", "UPBBI.y", "RIB.z", "ROB.x", "SFF.y", "SFR.z",
    "WLC.x", "WLC.z", "llf.Fx", "llr.Fx", "llr.cubic.Fx", "llr.preload.Fy", "sff.Fy", "upb.Fy", "upb.Tx",
    "scb.Tz", "bump_stop.clearance", "rebound_stop.clearance", "bump_stop.factor", "spring.rate",
    "arb.radius", "tyre.rate", "tyre.static_load", "static.toe", "static.camber", "ride_height",
    "damper.gas_force", "right.LLR.y", "right.llr.Fx", "left.WLC.z",
)  # fmt: skip


@pytest.fixture(scope="module")
def free() -> tuple[Axle, Sensitivities]:
    axle = with_values(short(nominal()), {"damper.gas_force": 50.0})
    return axle, sensitivities(axle, tight(axle), FREE_PATHS)


@pytest.mark.parametrize("path", FREE_PATHS)
def test_friction_free(free: tuple[Axle, Sensitivities], path: str) -> None:
    axle, exact = free
    ratio, where = worst(axle, exact, path)
    assert ratio < 1e-5, where


@pytest.mark.parametrize("path", ["steering.rack_mm_per_rev", "WLC.y", "right.WLC.y"])
@pytest.mark.parametrize("friction", [False, True])
def test_dimensions_that_load_cases_use(path: str, *, friction: bool) -> None:
    """The rack's travel per turn, and the lever of pads that roll by an angle."""
    axle = apply_effect(short(nominal()), "roll_technique", {}, source="test")
    axle = replace(axle, load_cases={i: axle.load_cases[i] for i in ("roll", "steer")})
    if friction:
        axle = apply_effect(axle, "steering_friction", {}, source="test")
    exact = sensitivities(axle, tight(axle), [path])
    ratio, where = worst(axle, exact, path)
    assert ratio < 1e-5, where
    case = "roll" if path == "WLC.y" else "steer"
    assert path == "right.WLC.y" or np.abs(exact.branches[case][0][:, :, 0]).max() > 0.01


@pytest.mark.parametrize("gain", [1.0, 0.97])
@pytest.mark.parametrize("effect", ["", "steering_friction", "strut_friction"])
def test_the_gain_of_the_inputs(effect: str, gain: float) -> None:
    """Of each load case its own; pads that roll by an angle move by its tangent."""
    axle = apply_effect(short(nominal()), "roll_technique", {}, source="test")
    axle = moved(axle, INPUT_GAIN, gain - 1.0)
    if effect:
        axle = apply_effect(axle, effect, {}, source="test")
    exact = sensitivities(axle, tight(axle), ["spring.rate"], input_gain=INPUT_GAIN)
    assert exact.paths == ("spring.rate", INPUT_GAIN)
    assert not exact.static[:, 1].any() and exact.static[:, 0].any()
    ratio, where = worst(axle, exact, INPUT_GAIN)
    assert ratio < 1e-5, where
    for case, branches in exact.branches.items():
        assert np.abs(branches[0][:, :, 1]).max() > 0.01, case


@pytest.mark.parametrize("path", ["strut.flexibility", "right.strut.flexibility"])
@pytest.mark.parametrize("effect", ["", "strut_friction"])
def test_a_rigid_strut_has_the_one_sided_derivative_to_its_flexibility(path: str, effect: str) -> None:
    axle = replace(short(nominal()), load_cases={"lateral": short(nominal()).load_cases["lateral"]})
    if effect:
        axle = apply_effect(axle, effect, {}, source="test")
    rigid = tight(axle)
    exact = sensitivities(axle, rigid, ["spring.rate", path])
    h = 2e-3
    near, far = (tight(with_values(axle, {path: size})) for size in (h, 2 * h))
    toe = [rigid.column(f"toe@{side}") for side in "LR"]
    for i, branch in enumerate(rigid.cases["lateral"].branches):
        one, two = (s.cases["lateral"].branches[i].y - branch.y for s in (near, far))
        found, mine = ((4 * one - two) / (2 * h))[:, toe], exact.branches["lateral"][i][:, toe, 1]
        assert np.abs(mine).max() > 1e-3
        np.testing.assert_allclose(mine, found, rtol=0, atol=1e-4 * np.abs(mine).max())
    alone = sensitivities(axle, rigid, ["spring.rate"])
    for one, other in zip(alone.branches["lateral"], exact.branches["lateral"], strict=True):
        np.testing.assert_allclose(one[:, :, 0], other[:, :, 0], rtol=1e-9, atol=1e-12)


LOOPS = {
    "dahl": [("steering_friction", {}), ("strut_friction", {})],
    "iwan": [("steering_friction", {"law": "iwan"}), ("strut_friction", {"law": "iwan"})],
    "compliant": [
        ("hub_compliance", {"law": "stiffening", "loaded_factor": 1.4}),
        ("strut_bending", {"law": "stiffening", "loaded_factor": 0.7, "reference_Nm": 200.0}),
        ("rack_mount_compliance", {}),
        ("steer_arm_compliance", {}),
        ("subframe_flexibility", {}),
        ("tyre_horizontal_compliance", {}),
    ],
    "free play": [("tie_rod_free_play", {"gap_mm": 0.2}), ("tie_rod_compliance", {})],
    "joints": [
        ("ball_joint_compliance", {}),
        ("tie_rod_compliance", {}),
        ("anti_roll_bar_link_compliance", {}),
        ("power_assist", {}),
    ],
}
LOOP_PATHS = {
    "dahl": ("steering_friction.force", "steering_friction.presliding", "strut_friction.force", "ROB.x",
             "UPB.y", "scb.Tz", "llr.Fx", "spring.rate", "ride_height"),
    "iwan": ("steering_friction.force", "ROB.x", "scb.Tz"),
    "compliant": ("hub.camber", "hub.toe", "hub.loaded_factor", "hub.reference", "strut.flexibility",
                  "strut.torsion", "strut.loaded_factor", "strut.reference", "rack_mount.rate",
                  "steer_arm.radius", "SAH.z", "subframe.ky", "subframe.krz", "tyre.lat_rate", "CLAMP.z"),
    "free play": ("tie_rod.gap", "tie_rod.contact", "tie_rod.flexibility", "ROB.x", "llr.Fx"),
    "joints": ("ball_joint.rate", "tie_rod.flexibility", "arb.link_flexibility", "power_assist.gain",
               "power_assist.reference", "LWB.y"),
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "path"), [(name, path) for name, paths in LOOP_PATHS.items() for path in paths]
)
def test_along_the_path_and_with_every_compliance(name: str, path: str) -> None:
    axle, exact = _with_effects(name)
    ratio, where = worst(axle, exact, path)
    assert ratio < 1e-5, where


@lru_cache
def _with_effects(name: str) -> tuple[Axle, Sensitivities]:
    # no equilibrium of a loop where the stop just touches, a corner
    axle = with_values(short(nominal()), {"rebound_stop.clearance": 63.0})
    for ident, options in LOOPS[name]:
        axle = apply_effect(axle, ident, options, source="test")
    return axle, sensitivities(axle, tight(axle), LOOP_PATHS[name])


def interpreted(monkeypatch: pytest.MonkeyPatch, axle: Axle, solution: Solution) -> Sensitivities:
    with monkeypatch.context() as patch:
        patch.setattr(
            sensitivity,
            "derivatives_of",
            lambda topology, c, dc: InterpretedDerivatives(kernel(topology), c, dc),
        )
        return sensitivities(axle, solution, settable_paths(axle))


def test_outputs_that_are_asked_for_are_the_same_columns(free: tuple[Axle, Sensitivities]) -> None:
    axle, every = free
    wanted = ("toe@R", "wc_y@L")
    solution = tight(axle)
    some = sensitivities(axle, solution, every.paths, outputs=wanted)
    assert some.columns == wanted and every.columns == solution.output_names
    np.testing.assert_array_equal(some.static, every.static)
    for ident, branches in some.branches.items():
        for own, row in zip(branches, every.along(ident, wanted), strict=True):
            np.testing.assert_array_equal(own, row)
        for one, turned in zip(branches, some.along(ident, wanted[::-1]), strict=True):
            np.testing.assert_array_equal(one, turned[:, ::-1])


def test_load_cases_side_by_side_have_the_same_derivatives(free: tuple[Axle, Sensitivities]) -> None:
    axle, every = free
    with ThreadPoolExecutor(3) as pool:
        beside = sensitivities(axle, tight(axle), every.paths, pool=pool)
    np.testing.assert_array_equal(beside.static, every.static)
    assert list(beside.branches) == list(every.branches)
    for ident, branches in every.branches.items():
        for own, other in zip(branches, beside.branches[ident], strict=True):
            np.testing.assert_array_equal(own, other)


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
@pytest.mark.parametrize("name", [*EXAMPLE_TYPES, *LOOPS])
def test_compiled_derivatives_are_the_interpreted_ones(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of every axle type, and of every effect, but for rounding of what a parameter moves
    most, or not at all."""
    axle = _with_effects(name)[0] if name in LOOPS else read_axle(example_folder(name) / "axle.toml")
    solution = solve(axle, [case for case in ("vertical", "lateral", "steer") if case in axle.load_cases])
    compiled = sensitivities(axle, solution, settable_paths(axle))
    assert isinstance(
        derivatives_of(axle.topology, np.zeros(0), sparse.csr_array((0, 0))), CompiledDerivatives
    )
    expected = interpreted(monkeypatch, axle, solution)
    most = np.max([np.abs(b).max(axis=(0, 1)) for case in expected.branches.values() for b in case], axis=0)
    gap = np.abs(compiled.static - expected.static)
    assert (gap <= 1e-9 * np.abs(expected.static) + 1e-10 * most + ROUNDING).all()
    for case, branches in expected.branches.items():
        largest = np.abs(np.concatenate(branches)).max(axis=0)
        allowed = 1e-9 * largest + 1e-10 * largest.max(axis=0) + ROUNDING
        for own, other in zip(compiled.branches[case], branches, strict=True):
            gap = np.abs(own - other)
            worst_at = np.unravel_index(np.argmax(gap - allowed), gap.shape)
            assert (gap <= allowed).all(), (case, worst_at, gap[worst_at], largest[worst_at[1:]])


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
def test_a_singular_equilibrium_has_no_sensitivity() -> None:
    k = kernel(nominal().topology)
    c = np.zeros(len(k.constant_values(dict(nominal().values))))
    derivatives = derivatives_of(k.topology, c, sparse.csr_array((c.size, 1)))
    states = StateSequence(
        np.zeros((1, k.nx)), np.zeros((1, k.nu)), np.zeros((1, 0)), np.zeros((1, k.nu, 1)), np.ones(1, bool)
    )
    with pytest.raises(np.linalg.LinAlgError, match="no sensitivity exists"):
        derivatives.along(states, np.zeros((1, 1)), np.arange(k.ny), np.zeros((k.ny, 1)), np.zeros((0, 1)))


def test_characteristics_of_every_design_parameter() -> None:
    """Characteristic gradients against one-at-a-time values with a thousandth of the default step."""
    axle = nominal()
    parameters = [
        p for p in design_parameters(axle) if p.path not in {"strut.flexibility", "steer_arm.radius"}
    ]
    chosen = parameters[::6]
    exact = characteristic_gradients(axle, tight(axle), [p.path for p in chosen])
    for j, parameter in enumerate(chosen):
        h = 0.02 * parameter.step
        up, down = (
            np.array(list(reduce_all(curve_set(tight(with_values(axle, {parameter.path: v})))).values()))
            for v in (parameter.nominal + h, parameter.nominal - h)
        )
        scale = np.abs(exact).max(axis=1) * np.abs(exact[:, j]).max() / np.abs(exact).max()
        gap = np.abs((up - down) / (2 * h) - exact[:, j])
        assert (gap <= 1e-4 * np.abs(exact[:, j]) + 1e-6 * scale + 1e-7 / h * 0.01).all(), parameter.path


def test_more_than_a_hundred_parameters_at_once() -> None:
    axle = short(nominal())
    paths = settable_paths(axle)
    assert len(paths) >= 100
    exact = sensitivities(axle, tight(axle), paths)
    assert all(np.isfinite(d).all() for branches in exact.branches.values() for d in branches)
    assert len(CHARACTERISTICS) == characteristic_gradients(axle, tight(nominal()), paths[:3]).shape[0]


@pytest.mark.parametrize("count", [1, 2, 7, 8, 9, 31, 33, 65])
def test_few_parameters_have_the_derivatives_that_they_have_among_many(count: int) -> None:
    """Columns are handled some at once, by the width of the machine's registers, and what is left singly."""
    axle = with_values(short(nominal()), {"rebound_stop.clearance": 63.0})
    axle = apply_effect(axle, "strut_friction", {}, source="test")
    solution, paths = tight(axle), settable_paths(axle)[:80]
    every, some = sensitivities(axle, solution, paths), sensitivities(axle, solution, paths[:count])
    np.testing.assert_allclose(some.static, every.static[:, :count], rtol=1e-12, atol=1e-12)
    for ident, branches in some.branches.items():
        for own, among in zip(branches, every.branches[ident], strict=True):
            largest = np.abs(among[..., :count]).max(axis=(0, 1))
            assert (np.abs(own - among[..., :count]) <= 1e-12 * largest + 1e-300).all()
