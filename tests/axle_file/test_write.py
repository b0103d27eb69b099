"""Axles written back to their file: same values, same comments, few changed lines."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import Axle, parameter_value, with_values
from doe_kc.axle.model import strut_clamp
from doe_kc.axle_file import read_axle
from doe_kc.axle_file.write import AXLE_HEADER, write_axle
from doe_kc.characteristics import reduce_all
from doe_kc.effects import apply_effect
from doe_kc.ground.errors import InputError, RunError
from doe_kc.ground.files import read_toml
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.variables import VariableOptions, build_space
from tests.reference import EXAMPLE
from tests.reference import MCPHERSON_EFFECTS as EFFECTS

AXLE = EXAMPLE / "axle.toml"
PLAIN = AXLE.read_text(encoding="utf-8")
THIRD = 1.0 / 3.0


def effect(ident: str, option: str = "") -> str:
    return f"[effects.{ident}]\n{option}\n"


VARIANTS: dict[str, tuple[str, dict[str, float]]] = {
    "nothing": ("", {}),
    "hardpoints": ("", {"LLF.x": -2.0 + THIRD, "WLC.y": -790.1234567890123, "CLAMP.z": 341.7}),
    "followers move": ("", {"UPB.x": 40.0 + THIRD, "ROB.z": 283.1}),
    "follower set itself": ("", {"UPB.x": 41.3, "UPS.x": 36.9}),
    "bushing factors": ("", {"llf.Fx": 0.325, "llf.Tx": 1.385, "llr.Fx": 1.875 * THIRD, "scb.Tz": 1.1}),
    "bushing laws": ("", {"sff.stiffness.Fx": 1e4 * THIRD, "llr.cubic.Fx": 0.02, "upb.preload.Fz": -3.7}),
    "rates": ("", {"spring.rate": 28.7, "tyre.rate": 219.0, "arb.radius": 11.9, "damper.gas_force": 12.0}),
    "stops": (
        "",
        {"bump_stop.clearance": 22.5, "rebound_stop.clearance": 64.1, "bump_stop.factor": 2},
    ),
    "static": ("", {"ride_height": -THIRD, "static.toe": 0.1 + THIRD, "static.camber": -0.61}),
    "soft strut": ("", {"strut.flexibility": 0.7}),
    "right side": (
        "",
        {"right.LLR.y": 371.3, "right.llf.Fx": 1.1, "right.UPB.z": 861.1},
    ),
    "right file": (
        '[right]\n"LLR.y" = 372.0\n"static.toe" = -0.12\n"llr.Fx" = 1.2\n',
        {"LLR.y": -370.0 - THIRD, "static.toe": 0.03, "llr.Fx": 0.9},
    ),
    "only the right": ('[right]\n"UPB.x" = 43.0\n', {"left.UPB.x": 39.3}),
    "steer arm": (
        effect("steer_arm_compliance", "radius_mm = 13.0"),
        {"steer_arm.radius": 12.3, "SAH.x": 95.5},
    ),
    "hub": (effect("hub_compliance"), {"hub.camber": 5500.0 + THIRD}),
    "asymmetry": (effect("asymmetry", "scale = { LLR_R = 1.25 }"), {"llr.Fx": 0.8 * THIRD, "llr.Fy": 1.7}),
    "strut bending": (effect("strut_bending"), {"strut.flexibility": 0.4, "spring.rate": 27.0}),
    "stiff strut": (effect("strut_bending", "k_Nm_deg = 7000.0"), {"strut.bending": 6500.0}),
    "ride height": (effect("ride_height", "offset_mm = 5.0"), {"ride_height": 3.0 + THIRD}),
    "progression": (
        effect("bushing_progression", "UPB = [0, 0.02, 0.03]"),
        {"upb.cubic.Fz": 0.05 * THIRD},
    ),
    "rack": (effect("rack_mount_compliance"), {"rack_mount.rate": 5000.0 * THIRD}),
    "friction": (effect("steering_friction", "force_N = 210.0"), {"steering_friction.force": 190.0}),
}


def written(axle: Axle, text: str, tmp_path: Path) -> tuple[Path, str]:
    (tmp_path / "axle.toml").write_bytes(text.encode())
    path = write_axle(axle, tmp_path / "axle.toml", tmp_path / "new.toml")
    return path, path.read_bytes().decode()


def changed(text: str, values: Mapping[str, float], tmp_path: Path) -> Axle:
    (tmp_path / "axle.toml").write_bytes(text.encode())
    return with_values(read_axle(tmp_path / "axle.toml"), values)


@pytest.mark.parametrize("name", VARIANTS)
def test_reads_back_as_the_same_axle(name: str, tmp_path: Path) -> None:
    extra, values = VARIANTS[name]
    axle = changed(f"{PLAIN}\n{extra}", values, tmp_path)
    path, _ = written(axle, f"{PLAIN}\n{extra}", tmp_path)
    again = read_axle(path)
    assert dict(again.values) == dict(axle.values)
    assert again.topology == axle.topology
    assert again.follow == axle.follow


@pytest.mark.parametrize("name", VARIANTS)
def test_changes_few_lines_and_no_comment(name: str, tmp_path: Path) -> None:
    extra, values = VARIANTS[name]
    text = f"{PLAIN}\n{extra}"
    _, new = written(changed(text, values, tmp_path), text, tmp_path)
    lines = list(difflib.ndiff(text.splitlines(), new.splitlines()))
    removed = [line for line in lines if line.startswith("- ")]
    assert len(removed) <= 3 * len(values)
    assert new.startswith(AXLE_HEADER)
    comments = [line.partition("#")[2] for line in PLAIN.splitlines() if "#" in line]
    assert [c for c in comments if c not in new] == []


def test_a_follower_set_free_stays_where_it_was(tmp_path: Path) -> None:
    text = "\n".join(x for x in PLAIN.splitlines() if not x.startswith(('UPS = "UPB"', 'SAH = "ROB"')))
    axle = changed(text, {"UPB.x": 41.0 + THIRD, "ROB.y": -711.3, "SAH.y": -727.0}, tmp_path)
    again = read_axle(written(axle, text, tmp_path)[0])
    assert (dict(again.values), again.follow) == (dict(axle.values), {"UPBBI": "UPB"})
    assert again.values["UPS.x@L"] == 37.0


def test_a_whole_design_reads_back(tmp_path: Path) -> None:
    axle = read_axle(AXLE)
    options = VariableOptions.model_validate(
        {"use": ["*", "strut.flexibility"], "change": [{"match": "sfr.Fy", "tie": "sff.Fy"}]}
    )
    space = build_space(axle, options, "test")
    point = np.random.default_rng(3).random(space.dimension)
    moved = with_values(axle, space.values(point))
    path, text = written(moved, PLAIN, tmp_path)
    assert dict(read_axle(path).values) == dict(moved.values)
    assert reduce_all(curve_set(solve(read_axle(path)))) == reduce_all(curve_set(solve(moved)))
    assert text.count("\n") < PLAIN.count("\n") + 10


@pytest.mark.parametrize("effect_in", ["", "[effects.steering_ratio]\nfactor = 1.05\n"])
def test_the_rack_ratio_steers_the_same_before_and_after(effect_in: str, tmp_path: Path) -> None:
    """At the rate that is set, not at the one that the file was read with: 4 to 5 deg of toe at full lock."""
    text = f"{PLAIN}\n{effect_in}"
    nominal = changed(text, {}, tmp_path)
    axle = changed(text, {"steering.rack_mm_per_rev": 60.0}, tmp_path)
    again = read_axle(written(axle, text, tmp_path)[0])
    ends = []
    for each in (axle, again, nominal):
        found = solve(each, ["steer"], compiled=False)
        branch = found.cases["steer"].branches[0]
        ends.append(branch.y[-1, [found.column("rack_travel"), found.column("toe@L")]])
    np.testing.assert_array_equal(ends[0], ends[1])
    assert ends[0][0] / ends[2][0] == pytest.approx(
        60.0 / parameter_value(nominal, "steering.rack_mm_per_rev"), rel=0.01
    )
    assert abs(ends[0][1] - ends[2][1]) > 3.0


@pytest.mark.parametrize("ident", EFFECTS)
def test_an_effect_is_added_to_a_file_without_it(ident: str, tmp_path: Path) -> None:
    axle = apply_effect(with_values(read_axle(AXLE), {"LLF.z": 213.0}), ident, {}, source="test")
    path, text = written(axle, PLAIN, tmp_path)
    again = read_axle(path)
    assert (dict(again.values), again.topology) == (dict(axle.values), axle.topology)
    assert (ident in tomllib.loads(text).get("effects", {})) is not EFFECTS[ident].on_rig


def test_an_effect_that_is_gone_is_taken_out(tmp_path: Path) -> None:
    _, text = written(read_axle(AXLE), f"{PLAIN}\n[effects.hub_compliance]\n", tmp_path)
    assert "hub_compliance" not in text


def test_missing_keys_come_before_the_first_table(tmp_path: Path) -> None:
    keep = [x for x in PLAIN.splitlines() if not x.startswith(("ride_height", "[scb]", "Tz = 1.0", "CLAMP"))]
    text = "\n".join(keep)
    axle = changed(text, {"ride_height": 4.5, "scb.Tz": 1.3, "CLAMP.x": 5.0}, tmp_path)
    path, new = written(axle, text, tmp_path)
    document = read_toml(path)
    assert (document["ride_height"], document["scb"]) == (4.5, {"Tz": 1.3})
    assert document["hardpoints"]["CLAMP"] == [5.0, *strut_clamp(document["hardpoints"], ("LWD", "UPB"))[1:]]
    assert new.index("ride_height") < new.index("[units]")


def test_line_ends_and_an_older_header_are_kept_in_order(tmp_path: Path) -> None:
    text = (AXLE_HEADER + " 0.0 from x\n" + PLAIN).replace("\n", "\r\n")
    _, new = written(changed(text, {"spring.rate": 30.0}, tmp_path), text, tmp_path)
    assert new.count(AXLE_HEADER) == 1
    assert new.count("\n") == new.count("\r\n") == text.count("\n")


def test_a_note_cannot_break_the_comment(tmp_path: Path) -> None:
    path = write_axle(read_axle(AXLE), AXLE, tmp_path / "new.toml", note="a\nspring = 1\x00\u2028b")
    assert read_axle(path).values == read_axle(AXLE).values


def test_what_no_file_can_say_is_one_sentence(tmp_path: Path) -> None:
    axle = changed(f"{PLAIN}\n[effects.subframe_flexibility]\n", {}, tmp_path)
    name = next(n for n in axle.values if n.startswith("subframe."))
    odd = axle.changed({name: 1.7 * axle.values[name]})
    with pytest.raises(RunError, match=r"subframe\..* cannot be written beside"):
        write_axle(odd, tmp_path / "axle.toml", tmp_path / "new.toml")
    assert not (tmp_path / "new.toml").exists()


def test_a_missing_original_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"gone\.toml"):
        write_axle(read_axle(AXLE), tmp_path / "gone.toml", tmp_path / "new.toml")
