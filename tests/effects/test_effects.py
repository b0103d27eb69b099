"""Every effect: its defaults, what it refuses, and the same axle from a file as from the call."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from doe_kc.axle import parameter_value, with_values
from doe_kc.axle.model import BUSHINGS
from doe_kc.axle.places import places_of
from doe_kc.axle.topology import Topology
from doe_kc.axle_file import read_axle
from doe_kc.axle_file.write import write_axle
from doe_kc.axle_types import DEFAULT_TYPE, built_in
from doe_kc.effects import EFFECTS as ALL_EFFECTS
from doe_kc.effects import Option, apply_effect
from doe_kc.examples import example_folder
from doe_kc.ground.errors import InputError
from tests.reference import EXAMPLE, nominal
from tests.reference import MCPHERSON_EFFECTS as EFFECTS

TEXT = (EXAMPLE / "axle.toml").read_text()

DEFAULTS: dict[str, dict[str, float]] = {
    "anti_roll_bar_link_compliance": {"arb.link_flexibility": 1 / 300.0},
    "ball_joint_compliance": {"ball_joint.rate": 12000.0},
    "bushing_preload": {"llr.preload.Fx": 0.0, "llr.preload.Fy": 600.0, "llr.preload.Fz": 0.0},
    "bushing_progression": {"llr.cubic.Fx": 0.05, "upb.cubic.Fz": 0.02, "sff.cubic.Fx": 0.0},
    "hub_compliance": {"hub.camber": 6000.0, "hub.toe": 9000.0},
    "left_right_asymmetry": {"right.llr.Fx": 1.25, "right.llr.Fz": 1.25, "right.llr.Tx": 1.0, "llr.Fx": 1.0},
    "power_assist": {"power_assist.gain": 1.0, "power_assist.reference": 300.0},
    "rack_mount_compliance": {
        "rack_mount.rate": 6000.0,
        "rack_mount.stiffening": 0.0,
        "rack_mount.reference": 0.2,
    },
    "ride_height_offset": {"ride_height": 7.0},
    "rig_channel_gain": {},
    "rig_channel_offset": {},
    "rig_input_gain": {},
    "roll_technique": {},
    "rubber_hysteresis": {"llr.rubber.share": 0.2, "right.upb.rubber.yield": 0.2, "sff.rubber.spread": 0.8}
    | {f"{b}.rubber.share": 0.2 for b in ("llf", "sff", "sfr", "upb")},
    "steer_arm_compliance": {"steer_arm.radius": 14.0},
    "steering_friction": {"steering_friction.force": 250.0, "steering_friction.presliding": 0.05},
    "steering_ratio": {"steering.rack_mm_per_rev": 1.03 * 52.0},
    "strut_bending": {"strut.flexibility": 1.0, "strut.bending": 8000.0, "strut.torsion": 30000.0},
    "strut_friction": {"strut_friction.force": 120.0, "right.strut_friction.presliding": 0.3},
    "subframe_flexibility": {"subframe.kx": 80000.0, "subframe.kz": 40000.0, "subframe.krx": 3000.0},
    "tie_rod_compliance": {"tie_rod.flexibility": 1 / 15000.0},
    "tie_rod_free_play": {"tie_rod.gap": 0.2, "tie_rod.contact": 20000.0},
    "tyre_horizontal_compliance": {"tyre.lat_rate": 180.0, "tyre.long_rate": 250.0},
}
PLAIN = Topology(built_in(DEFAULT_TYPE).structure)
TOPOLOGIES: dict[str, dict[str, Any]] = {
    "ball_joint_compliance": {"elastic_balls": ("ball_joint@L", "ball_joint@R")},
    "hub_compliance": {"hub": True},
    "power_assist": {"power_assist": True},
    "rack_mount_compliance": {"rack_mount": True},
    "rubber_hysteresis": {"rubber": tuple(BUSHINGS)},
    "steer_arm_compliance": {"steer_arm": True},
    "steering_friction": {"steering_friction": "dahl"},
    "strut_bending": {"strut_bending": True},
    "strut_friction": {"strut_friction": "dahl"},
    "subframe_flexibility": {"flexible_subframe": True},
    "tie_rod_free_play": {"free_play_left": True, "free_play_right": True},
    "tyre_horizontal_compliance": {"tyre_horizontal": True},
}
OPTIONS: dict[str, dict[str, Any]] = {
    "anti_roll_bar_link_compliance": {"k_N_mm": 250.0},
    "ball_joint_compliance": {"k_N_mm": 9000},
    "bushing_preload": {"SFF": [10.0, 20.0, -30.0], "upb": [1, 2, 3]},
    "bushing_progression": {"LLF": [0.1, 0.0, 0.2], "added": True},
    "hub_compliance": {"camber_Nm_deg": 4000},
    "left_right_asymmetry": {"scale": {"SFF_L": 0.8, "LLF_R": 1.1}},
    "power_assist": {"gain": 2.0},
    "rack_mount_compliance": {"k_N_mm": 5000.0},
    "ride_height_offset": {"offset_mm": -4.0},
    "rig_channel_gain": {"camber": 0.98, "wc_z": 1.01},
    "rig_channel_offset": {"camber_deg": -0.2},
    "rig_input_gain": {"brake": 1.1},
    "roll_technique": {"technique": "wheel_to_ground"},
    "rubber_hysteresis": {"bushings": ["LLR", "UPB"], "share": {"LLR": 0.3, "UPB": 0.1}, "spread": 0.5},
    "steer_arm_compliance": {"radius_mm": 11.0},
    "steering_friction": {"force_N": 99.0, "law": "iwan"},
    "steering_ratio": {"factor": 0.97},
    "strut_bending": {"k_Nm_deg": 7000.0, "torsion_Nm_deg": 20000.0},
    "strut_friction": {"presliding_mm": 0.2, "law": "dahl"},
    "subframe_flexibility": {"mode": "flexible", "scale": 2.0},
    "tie_rod_compliance": {"k_N_mm": 8000.0},
    "tie_rod_free_play": {"joints": ["ROB_R"], "gap_mm": 0.1},
    "tyre_horizontal_compliance": {"k_lat_N_mm": 200.0},
}
UNLIKE = {"share_factors": [0.5, 1.5, 1.0, 0.8, 1.2], "yield_factors": [1.0, 0.7, 1.4, 1.0, 1.0]}
"""Of rubber by law each: LLF, LLR, SFF, SFR, UPB."""
IN_FILES = [ident for ident, effect in EFFECTS.items() if not effect.on_rig]
NUMBERS = [(i, k) for i, e in EFFECTS.items() for k, o in e.options.items() if isinstance(o.default, float)]


def applied(ident: str, options: dict[str, Any] | None = None):
    return apply_effect(nominal(), ident, options or {}, source="axle.toml")


def toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + " }"
    return json.dumps(value)


def test_every_effect_is_tested_here() -> None:
    assert set(DEFAULTS) == set(OPTIONS) == set(EFFECTS)


@pytest.mark.parametrize("ident", EFFECTS)
def test_defaults_are_those_of_the_reference(ident: str) -> None:
    axle = applied(ident)
    for path, value in DEFAULTS[ident].items():
        assert parameter_value(axle, path) == value, path
    assert axle.topology == replace(PLAIN, **TOPOLOGIES.get(ident, {}))
    assert axle.effects == {ident: {}}
    assert nominal().effects == {}
    assert nominal().topology == PLAIN


@pytest.mark.parametrize("ident", EFFECTS)
def test_an_effect_changes_nothing_but_its_own_values(ident: str) -> None:
    before, after = nominal().values, applied(ident).values
    changed = {k.split("@")[0] for k, v in after.items() if before.get(k) != v}
    own = {p.removeprefix("right.") for p in DEFAULTS[ident]}
    families = {p.rpartition(".")[0] for p in own} | own
    assert all(c in own or c.rpartition(".")[0] in families for c in changed), changed


@pytest.mark.parametrize("ident", IN_FILES)
def test_from_a_file_it_is_the_same_axle(ident: str, tmp_path: Path) -> None:
    path = tmp_path / "axle.toml"
    lines = "\n".join(f"{k} = {toml(v)}" for k, v in OPTIONS[ident].items())
    path.write_text(f"{TEXT}\n[effects.{ident}]\n{lines}\n")
    assert read_axle(path) == applied(ident, OPTIONS[ident])


@pytest.mark.parametrize("ident", EFFECTS)
def test_an_unknown_key_is_named_with_the_file(ident: str) -> None:
    with pytest.raises(InputError) as caught:
        applied(ident, {"nonsense": 1.0})
    for part in ("axle.toml", "nonsense"):
        assert part in str(caught.value)


@pytest.mark.parametrize(("ident", "key"), NUMBERS)
@pytest.mark.parametrize(
    "value", ["1", None, True, [], {}, math.nan, math.inf, -math.inf, 10**400], ids=lambda v: str(v)[:9]
)
def test_a_number_must_be_a_finite_number(ident: str, key: str, value: object) -> None:
    with pytest.raises(InputError) as caught:
        applied(ident, {key: value})
    for part in ("axle.toml", ident, key, "finite number"):
        assert part in str(caught.value)


@pytest.mark.parametrize(("ident", "key"), NUMBERS)
@pytest.mark.parametrize("value", [0, -1.0])
def test_zero_and_negative_values(ident: str, key: str, value: float) -> None:
    if EFFECTS[ident].options[key].positive:
        with pytest.raises(InputError, match=f"{ident}: {key} = .*> 0"):
            applied(ident, {key: value})
    elif ident == "ride_height_offset":
        assert applied(ident, {key: value}).values["ride_height"] == value
    else:
        assert applied(ident, {key: value / 2.0}).values["rack_mount.stiffening"] == value / 2.0


def test_a_mount_whose_force_would_fall_is_refused() -> None:
    with pytest.raises(InputError, match=r"stiffening = -0.9, expected more than -0.88"):
        applied("rack_mount_compliance", {"stiffening": -0.9})


def test_the_near_key_is_suggested() -> None:
    with pytest.raises(InputError, match='Did you mean "toe_Nm_deg"'):
        applied("hub_compliance", {"toe_Nm_dge": 1.0})
    with pytest.raises(InputError, match=r'unknown effect .* Did you mean "strut_bending"'):
        applied("strut_bendng")
    with pytest.raises(InputError, match='Did you mean "LLR_R"'):
        applied("left_right_asymmetry", {"LRR_R": 1.0})


@pytest.mark.parametrize(
    ("ident", "options"),
    [
        ("steering_friction", {"law": "coulomb"}),
        ("strut_friction", {"law": ["dahl"]}),
        ("steering_friction", {"law": "lognormal", "spread": 0.0}),
        ("strut_friction", {"law": "backbone", "shares": [1.0, 1.0]}),
        ("strut_friction", {"law": "backbone", "shares": [1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0]}),
        ("strut_friction", {"law": "backbone", "shares": "1111111"}),
        ("rubber_hysteresis", {"bushings": ["LLX"]}),
        ("rubber_hysteresis", {"bushings": []}),
        ("rubber_hysteresis", {"bushings": 3}),
        ("rubber_hysteresis", {"share": {"LLR": 0.2}}),
        ("rubber_hysteresis", {"bushings": ["LLR"], "yield_mm": {"LLR": 0.2, "LLF": 0.2}}),
        ("rubber_hysteresis", {"bushings": ["LLR"], "yield_mm": {"LLR": 0.0}}),
        ("rubber_hysteresis", {"law": "unlike"}),
        ("rubber_hysteresis", {"law": "each", "share_factors": [1.0]}),
        ("rubber_hysteresis", {"law": "each", "yield_factors": 1.5}),
        ("rubber_hysteresis", {"law": "each", "yield_factors": [1.0, 1.0, -1.0, 1.0, 1.0]}),
        ("subframe_flexibility", {"mode": "soft"}),
        ("tie_rod_free_play", {"joints": ["ROB"]}),
        ("tie_rod_free_play", {"joints": []}),
        ("tie_rod_free_play", {"joints": 3}),
        ("tie_rod_free_play", {"joints": None}),
        ("tie_rod_free_play", {"joints": [["ROB_L"]]}),
        ("tie_rod_free_play", {"contact_N_mm": 0.0}),
        ("roll_technique", {"technique": "road"}),
        ("rig_channel_gain", {"caster": 1.05}),
        ("rig_channel_gain", {"toe": 0.0}),
        ("rig_channel_gain", {"toe": "1.05"}),
        ("rig_channel_offset", {"toe": 0.1}),
        ("rig_channel_offset", {"toe_deg": math.nan}),
        ("rig_input_gain", {"heave": 1.05}),
        ("rig_input_gain", {"lateral": -1.0}),
        ("bushing_preload", {"LLR": [1.0, 2.0]}),
        ("bushing_preload", {"LLR": [1.0, 2.0, 3.0], "added": 1}),
        ("bushing_preload", {"LLR": 1.0}),
        ("bushing_preload", {"LLR": ["a", 0.0, 0.0]}),
        ("bushing_preload", {"LLX": [0.0, 0.0, 0.0]}),
        ("bushing_progression", {"LLR": [-0.1, 0.0, 0.0]}),
        ("bushing_progression", {"LLR": [math.nan, 0.0, 0.0]}),
        ("left_right_asymmetry", {"scale": 1.25}),
        ("left_right_asymmetry", {"scale": {"LLR": 1.25}}),
        ("left_right_asymmetry", {"LLR_R": 0.0}),
        ("left_right_asymmetry", {"LLR_R": "1.25"}),
    ],
    ids=str,
)
def test_other_wrong_values(ident: str, options: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"axle\.toml"):
        applied(ident, options)


def test_free_play_of_one_joint_as_text() -> None:
    topology = applied("tie_rod_free_play", {"joints": "ROB_L"}).topology
    assert (topology.free_play_left, topology.free_play_right) == (True, False)


def test_a_rigid_sub_frame_takes_the_effect_back() -> None:
    flexible = applied("subframe_flexibility")
    rigid = apply_effect(flexible, "subframe_flexibility", {"mode": "rigid"}, source="t")
    assert rigid.topology == PLAIN


def test_the_command_line_s_dotted_key_is_the_nested_one() -> None:
    a = applied("left_right_asymmetry", {"scale.LLR_R": 1.1}).values
    assert a == applied("left_right_asymmetry", {"LLR_R": 1.1}).values
    assert a == applied("left_right_asymmetry", {"scale": {"LLR_R": 1.1}}).values


def test_effects_add_up_in_any_order() -> None:
    one = apply_effect(applied("hub_compliance"), "steering_friction", {}, source="t")
    other = apply_effect(applied("steering_friction"), "hub_compliance", {}, source="t")
    assert one == other
    assert set(one.effects) == {"hub_compliance", "steering_friction"}


def test_options_are_positive_unless_they_say_otherwise() -> None:
    assert Option(1.0).positive


@pytest.mark.parametrize("ident", [i for i, e in EFFECTS.items() if e.on_rig])
def test_an_axle_file_does_not_hold_faults_of_the_measurement(ident: str, tmp_path: Path) -> None:
    path = tmp_path / "axle.toml"
    path.write_text(f"{TEXT}\n[effects.{ident}]\n")
    with pytest.raises(InputError, match=rf"axle\.toml.*\[effects\.{ident}\].*Remove the table"):
        read_axle(path)
    # but a search may carry it along, and the axle with it can be written
    changed = with_values(applied(ident), {"LLF.z": 213.0})
    written = write_axle(changed, EXAMPLE / "axle.toml", tmp_path / "out.toml")
    assert read_axle(written).values == changed.values
    assert read_axle(written).effects == {}


def test_values_on_top_of_the_bushing_s_own() -> None:
    base = with_values(nominal(), {"llr.preload.Fx": 100.0, "right.llr.preload.Fy": -50.0})
    one = apply_effect(base, "bushing_preload", {"LLR": [10.0, 20.0, 0.0], "added": True}, source="t")
    assert parameter_value(one, "llr.preload.Fx") == 110.0
    assert parameter_value(one, "right.llr.preload.Fy") == -30.0
    other = apply_effect(base, "bushing_preload", {"LLR": [10.0, 20.0, 0.0]}, source="t")
    assert parameter_value(other, "llr.preload.Fx") == 10.0


def test_the_ride_height_offset_is_on_top_of_the_file_s() -> None:
    raised = apply_effect(with_values(nominal(), {"ride_height": 2.0}), "ride_height_offset", {}, source="t")
    assert raised.values["ride_height"] == 9.0


@pytest.mark.parametrize(
    ("ident", "first", "second"),
    [
        ("bushing_preload", {"LLR": [1.0, 2.0, 3.0]}, {"SFF": [4.0, 5.0, 6.0]}),
        ("bushing_preload", {"LLR": [1.0, 2.0, 3.0]}, {"LLR": [4.0, 5.0, 6.0], "added": True}),
        ("bushing_progression", {"LLR": [0.1, 0.0, 0.0], "added": True}, {"UPB": [0.1, 0.0, 0.0]}),
        ("left_right_asymmetry", {"LLR_R": 1.2}, {"scale": {"LLR_R": 1.1, "LLF_L": 0.9}}),
        ("rubber_hysteresis", {"bushings": ["LLR"]}, {"bushings": ["UPB"], "share": 0.1}),
        ("rubber_hysteresis", {}, {"bushings": ["LLR"], "yield_mm": 0.3}),
        ("steering_friction", {"law": "lognormal", "spread": 0.5}, {"law": "backbone"}),
        ("steering_ratio", {"factor": 1.02}, {"factor": 1.05}),
        ("ride_height_offset", {"offset_mm": 2.0}, {"offset_mm": -5.0}),
        ("hub_compliance", {"camber_Nm_deg": 5000.0}, {"toe_Nm_deg": 5000.0}),
    ],
)
def test_an_effect_given_twice_is_recorded_as_one_table(
    ident: str, first: dict[str, Any], second: dict[str, Any]
) -> None:
    twice = apply_effect(applied(ident, first), ident, second, source="t")
    once = applied(ident, dict(twice.effects[ident]))
    assert once.topology == twice.topology
    assert once.values == pytest.approx(dict(twice.values), rel=1e-14)


def test_faults_of_several_channels_add_up() -> None:
    axle = apply_effect(
        applied("rig_channel_gain", {"toe": 1.1}), "rig_channel_gain", {"wc_x": 0.9}, source="t"
    )
    assert axle.effects["rig_channel_gain"] == {"toe": 1.1, "wc_x": 0.9}


@pytest.mark.parametrize(
    ("ident", "options"),
    [
        ("steering_friction", {}),
        ("strut_friction", {"law": "backbone", "shares": [0.1, 0.1, 0.2, 0.2, 0.2, 0.1, 0.1]}),
        ("steering_friction", {"law": "lognormal", "spread": 0.4}),
        ("rubber_hysteresis", {"bushings": ["LLR", "UPB"], "share": {"LLR": 0.3, "UPB": 0.1}}),
        ("rubber_hysteresis", {}),
        ("rubber_hysteresis", {"law": "each", **UNLIKE}),
    ],
    ids=str,
)
def test_a_friction_is_written_and_read_back(ident: str, options: dict[str, Any], tmp_path: Path) -> None:
    """With a value of the axle moved that no key of the file holds: an option of the effect follows."""
    path = {"rubber_hysteresis": "llr.rubber.share"}.get(ident, f"{ident}.presliding")
    axle = applied(ident, options)
    changed = with_values(axle, {path: 1.1 * parameter_value(axle, path), "LLF.z": 213.0})
    tried = [axle, changed] if options != {} or ident != "rubber_hysteresis" else [axle]
    for i, each in enumerate(tried):
        written = write_axle(each, EXAMPLE / "axle.toml", tmp_path / f"{i}.toml")
        again = read_axle(written)
        assert again.topology == each.topology
        assert again.values == pytest.approx(dict(each.values), rel=1e-12)


def test_bushings_each_by_factors_of_its_own_are_those_named_one_by_one() -> None:
    names = [b.upper() for b in BUSHINGS]
    each = applied("rubber_hysteresis", {"law": "each", "share": 0.3, "yield_mm": 0.1, **UNLIKE})
    one_by_one = {
        "share": {n: 0.3 * f for n, f in zip(names, UNLIKE["share_factors"], strict=True)},
        "yield_mm": {n: 0.1 * f for n, f in zip(names, UNLIKE["yield_factors"], strict=True)},
    }
    assert each.values == pytest.approx(dict(applied("rubber_hysteresis", one_by_one).values), rel=1e-12)
    assert applied("rubber_hysteresis", UNLIKE).values == applied("rubber_hysteresis").values


def test_the_table_name_of_a_file_is_the_effect_too() -> None:
    """`[hub]` in a file of reference data and `hub_compliance` are one effect; tables are unique."""
    tables = [e.table for e in EFFECTS.values() if e.table]
    assert len(set(tables)) == len(tables) and not set(tables) & set(EFFECTS)
    for effect in EFFECTS.values():
        if effect.table:
            named = apply_effect(nominal(), effect.table, {}, source="test")
            assert named == apply_effect(nominal(), effect.id, {}, source="test")


@pytest.mark.parametrize(
    ("axle_type", "ident"), [("mcpherson_front", "strut_friction"), ("rigid_rear", "damper_friction")]
)
@pytest.mark.parametrize("name", ["strut_friction", "damper_friction"])
def test_friction_of_the_damper_by_either_name(axle_type: str, ident: str, name: str) -> None:
    plain = read_axle(example_folder(axle_type) / "axle.toml")
    axle = apply_effect(plain, name, {"force_N": 80.0}, source="test")
    assert list(axle.effects) == [ident]
    assert axle.values["strut_friction.force@L"] == 80.0
    both = [ALL_EFFECTS[e] for e in ("strut_friction", "damper_friction")]
    assert [e.id for e in both if e.possible(places_of(plain))] == [ident]
