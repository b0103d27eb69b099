"""`with_values`: absolute values, followers, sides; its derivative; what it refuses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from doe_kc.axle import Axle, design_parameters, parameter_value, with_values
from doe_kc.axle.parameters import ParameterMap, internal_gradient, settable_paths
from doe_kc.axle_file import read_axle
from doe_kc.effects import apply_effect
from doe_kc.examples import EXAMPLE_TYPES, example_folder
from doe_kc.ground.errors import InputError
from tests.reference import MCPHERSON_EFFECTS as EFFECTS
from tests.reference import nominal

PATHS = settable_paths(nominal())
SIDED = [p for p in PATHS if f"{p}@L" in nominal().values]


def follower_free(paths: list[str]) -> list[str]:
    return [p for p in paths if p.split(".")[0] not in ("UPB", "ROB")]


def everything() -> Axle:
    axle = nominal()
    for ident in EFFECTS:
        axle = apply_effect(axle, ident, {}, source="test")
    return axle


@pytest.mark.parametrize("path", PATHS)
def test_a_path_holds_what_it_was_set_to_on_both_sides(path: str) -> None:
    value = parameter_value(nominal(), path) * 1.1 + 0.25
    axle = with_values(nominal(), {path: value})
    assert parameter_value(axle, path) == pytest.approx(value)
    if path in SIDED:
        left, right = axle.values[f"{path}@L"], axle.values[f"{path}@R"]
        assert left == pytest.approx(right)


def test_the_axle_is_not_changed_in_place() -> None:
    before = dict(nominal().values)
    with_values(nominal(), {"LLF.x": 5.0})
    assert dict(nominal().values) == before


def test_setting_what_is_there_changes_nothing() -> None:
    axle = with_values(nominal(), {p: parameter_value(nominal(), p) for p in PATHS})
    assert axle == nominal()


def changed(axle: Axle) -> dict[str, float]:
    base = nominal().values
    return {k: v - base[k] for k, v in axle.values.items() if v != base[k]}


def test_followers_move_along() -> None:
    moved = changed(with_values(nominal(), {"UPB.y": -573.0}))
    assert moved == {f"{p}.y@{s}": 2.0 for p in ("UPB", "UPS", "UPBBI") for s in "LR"}
    assert changed(with_values(nominal(), {"ROB.x": 134.0})) == {
        f"{p}.x@{s}": -1.0 for p in ("ROB", "SAH") for s in "LR"
    }
    assert changed(with_values(nominal(), {"right.UPB.y": 573.0})) == {
        f"{p}.y@R": 2.0 for p in ("UPB", "UPS", "UPBBI")
    }


@pytest.mark.parametrize("order", [("UPB.x", "UPS.x"), ("UPS.x", "UPB.x")])
def test_a_follower_that_is_set_itself_stays_where_it_is_set(order: tuple[str, str]) -> None:
    values = {"UPB.x": 43.0, "UPS.x": 30.0}
    axle = with_values(nominal(), {k: values[k] for k in order})
    assert parameter_value(axle, "UPS.x") == 30.0
    assert parameter_value(axle, "UPB.x") == 43.0
    assert parameter_value(axle, "UPBBI.x") == 43.0
    # other axes still follow
    axle = with_values(nominal(), {"UPB.x": 43.0, "UPB.z": 862.0, "UPS.x": 30.0})
    assert parameter_value(axle, "UPS.z") == 837.0


@pytest.mark.parametrize("leader", ["UPB.x", "left.UPB.x"])
@pytest.mark.parametrize("follower", ["UPS.x", "left.UPS.x"])
def test_an_explicit_side_of_a_follower_wins_too(leader: str, follower: str) -> None:
    for values in ({leader: 43.0, follower: 30.0}, {follower: 30.0, leader: 43.0}):
        axle = with_values(nominal(), values)
        assert parameter_value(axle, follower) == 30.0
        assert parameter_value(axle, leader) == 43.0


@pytest.mark.parametrize("values", [{"LLF.x": 1.0, "right.LLF.x": 7.0}, {"right.LLF.x": 7.0, "LLF.x": 1.0}])
def test_a_side_set_beside_the_plain_path_holds_its_own_value(values: dict[str, float]) -> None:
    axle = with_values(nominal(), values)
    assert parameter_value(axle, "LLF.x") == 1.0
    assert parameter_value(axle, "right.LLF.x") == 7.0


def test_right_paths_are_chassis_coordinates() -> None:
    axle = with_values(nominal(), {"right.LLR.y": 374.0, "right.LLR.x": 301.0})
    assert parameter_value(axle, "right.LLR.y") == 374.0
    assert parameter_value(axle, "right.LLR.x") == 301.0
    assert (axle.values["LLR.y@R"], axle.values["LLR.y@L"]) == (-374.0, -370.0)


def test_an_asymmetric_axle_keeps_difference_and_ratio() -> None:
    axle = with_values(nominal(), {"right.LLR.y": 374.0, "right.llr.Fx": 1.25})
    axle = with_values(axle, {"LLR.y": -371.0, "llr.Fx": 0.8})
    assert parameter_value(axle, "right.LLR.y") == pytest.approx(375.0)
    assert parameter_value(axle, "right.llr.Fx") == pytest.approx(1.0)


@pytest.mark.parametrize(
    "axle",
    [nominal(), with_values(nominal(), {"right.llr.Fx": 1.25, "left.ROB.x": 130.0})],
    ids=["symmetric", "asymmetric"],
)
def test_the_internal_gradient_is_the_finite_difference(axle: Axle) -> None:
    paths = PATHS + [f"right.{p}" for p in SIDED] + [f"left.{p}" for p in SIDED]
    for path in paths:
        value, h = parameter_value(axle, path), 0.125
        if value == 0.0 and "strut" in path:
            continue  # below zero there is nothing
        ahead = with_values(axle, {path: value + h}).values
        found = {k: (v - axle.values[k]) / h for k, v in ahead.items() if v != axle.values[k]}
        expected = internal_gradient(axle, path)
        assert set(found) == set(expected), path
        np.testing.assert_allclose(
            [found[k] for k in sorted(found)], [expected[k] for k in sorted(found)], rtol=1e-9, err_msg=path
        )


UNKNOWN = [
    ("LLF.w", "LLF."),
    ("LFL.x", "LL"),
    ("lrr.Fx", "llr.Fx"),
    ("spring.ratte", "spring.rate"),
    ("static.tow", "static.toe"),
    ("ride_hight", "ride_height"),
    ("right.LLF.w", "LLF."),
]


@pytest.mark.parametrize(("path", "near"), UNKNOWN)
def test_an_unknown_path_names_its_nearest(path: str, near: str) -> None:
    for call in (lambda: with_values(nominal(), {path: 1.0}), lambda: parameter_value(nominal(), path)):
        with pytest.raises(InputError) as caught:
            call()
        assert path in str(caught.value)
        assert f'Did you mean "{near}' in str(caught.value)


@pytest.mark.parametrize(
    "path",
    [
        "",
        ".",
        "left",
        "right.",
        "LLF",
        "LLF.x@L",
        "bump_stop.table.x1",
        "left.right.LLF.x",
        "a" * 500,
        "LLF.x ",
        "ö",
    ],
)
def test_odd_paths_are_unknown_parameters(path: str) -> None:
    with pytest.raises(InputError, match="unknown parameter"):
        with_values(nominal(), {path: 1.0})


def test_a_side_of_a_whole_axle_value_is_refused() -> None:
    with pytest.raises(InputError, match="belongs to the whole axle"):
        with_values(nominal(), {"right.arb.radius": 12.0})


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
@pytest.mark.parametrize("path", ["LLF.x", "llr.Fx", "right.static.toe"])
def test_values_must_be_finite(path: str, value: float) -> None:
    with pytest.raises(InputError, match=f"{path} = .*finite"):
        with_values(nominal(), {path: value})


POSITIVE = {
    *("stiffness", "rate", "lat_rate", "long_rate", "factor", "column"),
    *("kx", "ky", "kz", "krx", "kry", "krz"),
    *("Fx", "Fy", "Fz", "Tx", "Ty", "Tz", "radius"),
}
STIFFNESSES = [
    p
    for p in settable_paths(everything())
    if p.split(".")[-1] in POSITIVE and "preload" not in p and "cubic" not in p
]


@pytest.mark.parametrize("path", STIFFNESSES)
def test_a_negative_stiffness_is_refused(path: str) -> None:
    axle = everything()
    for each in (path, f"right.{path}") if f"{path}@R" in axle.values else (path,):
        with pytest.raises(InputError, match=f"{each} = -1, expected a number >"):
            with_values(axle, {each: -1.0})


@pytest.mark.parametrize(
    "path",
    [
        "steering_friction.force",
        "strut_friction.presliding",
        "tie_rod.gap",
        "hub.camber",
        "strut.flexibility",
        "llr.cubic.Fx",
    ],
)
def test_a_negative_friction_gap_or_flexibility_is_refused(path: str) -> None:
    with pytest.raises(InputError):
        with_values(everything(), {path: -0.5})


@pytest.mark.parametrize("flexibility", [1e-6, 1e-3, 2.0])
def test_a_strut_of_any_flexibility_solves(flexibility: float) -> None:
    from doe_kc.solver.suite import solve

    axle = with_values(nominal(), {"strut.flexibility": flexibility})
    assert solve(axle, ["lateral"], compiled=False, throw=False).failure is None


def test_a_strut_that_bends_on_one_side_alone_still_solves() -> None:
    from doe_kc.solver.suite import solve

    axle = with_values(nominal(), {"right.strut.flexibility": 0.5})
    assert solve(axle, ["lateral"], compiled=False, throw=False).failure is None


@settings(max_examples=60, deadline=None)
@given(st.dictionaries(st.sampled_from(follower_free(PATHS)), st.floats(-0.4, 0.4), min_size=1, max_size=20))
def test_any_change_there_and_back_is_the_same_axle(changes: dict[str, float]) -> None:
    axle = nominal()
    before = {p: parameter_value(axle, p) for p in changes}
    wanted = {p: v + changes[p] * (abs(v) if v else 1.0) for p, v in before.items()}
    wanted = {p: abs(v) if "flexibility" in p or "cubic" in p or "gas" in p else v for p, v in wanted.items()}
    there = with_values(axle, wanted)
    for path, value in wanted.items():
        assert parameter_value(there, path) == pytest.approx(value, rel=1e-12, abs=1e-12)
    back = with_values(there, before)
    for name, value in axle.values.items():
        assert back.values[name] == pytest.approx(value, rel=1e-12, abs=1e-12)
    assert back.topology == axle.topology


@settings(max_examples=40, deadline=None)
@given(st.lists(st.sampled_from(PATHS), min_size=2, max_size=8, unique=True), st.randoms())
def test_the_order_of_the_values_does_not_matter(paths: list[str], random) -> None:
    values = {p: parameter_value(nominal(), p) * 1.05 + 0.5 for p in paths}
    shuffled = list(values.items())
    random.shuffle(shuffled)
    a, b = with_values(nominal(), values), with_values(nominal(), dict(shuffled))
    for path, value in values.items():
        assert parameter_value(a, path) == pytest.approx(value), path
    assert a.values == pytest.approx(dict(b.values))


def test_every_parameter_can_be_set_to_its_bounds() -> None:
    for p in design_parameters(nominal()):
        for value in (p.lower, p.upper):
            assert parameter_value(with_values(nominal(), {p.path: value}), p.path) == value


def test_paths_read_once_serve_axles_of_other_values() -> None:
    """What a path moves, relative to what it has, follows each axle; so does what moves along."""
    one = nominal()
    other = one.changed({name: 1.1 * value + 0.01 for name, value in one.values.items()})
    for path in SIDED:
        for axle in (one, other):
            value = 1.02 * parameter_value(axle, path) + 0.001
            changed = with_values(axle, {path: value})
            assert parameter_value(changed, path) == pytest.approx(value)
            gradient = internal_gradient(axle, path)
            step = value - parameter_value(axle, path)
            moved = {n: axle.values[n] + step * slope for n, slope in gradient.items()}
            assert {n: changed.values[n] for n in moved} == pytest.approx(moved)
    leading = with_values(replace(one, follow={}), {"ROB.x": 0.0})
    assert leading.values["SAH.x@L"] == one.values["SAH.x@L"]
    assert with_values(one, {"ROB.x": 0.0}).values["SAH.x@L"] != one.values["SAH.x@L"]


@pytest.mark.parametrize("name", EXAMPLE_TYPES)
def test_changes_of_many_designs_are_those_of_each(name: str) -> None:
    axle = read_axle(example_folder(name) / "axle.toml")
    paths = [p.path for p in design_parameters(axle)]
    paths += [f"right.{p}" for p in paths[:4]] + [f"left.{paths[7]}"]
    nominals = np.array([parameter_value(axle, p) for p in paths])
    rng = np.random.default_rng(2)
    values = nominals * rng.uniform(0.98, 1.02, (6, len(paths)))
    values[1] = nominals
    values[2, ::2] = nominals[::2]
    parameters = ParameterMap(axle, paths)
    changes = parameters.changes(values)
    for i, row in enumerate(values):
        expected = parameters.axle(list(row)).values
        found = {**axle.values, **{internal: float(v[i]) for internal, v in changes.items()}}
        assert found == pytest.approx(expected, rel=1e-15)
    bad = values.copy()
    bad[3, 2] = np.nan
    with pytest.raises(InputError, match="expected a finite number"):
        parameters.changes(bad)
