"""The example file is the reference axle; a bad file ends in a sentence that names file, key and remedy."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import design_parameters, parameter_value
from doe_kc.axle_file import read_axle
from doe_kc.axle_file.read import apply_effects, axle_from_document, plain_axle
from doe_kc.ground.errors import InputError
from tests.reference import EXAMPLE, nominal

TEXT = (EXAMPLE / "axle.toml").read_text()

REFERENCE = """
[points]
WLC  = [   0.0, -790.0, 310.0]
LWB  = [  -8.0, -748.0, 205.0]
UPB  = [  40.0, -575.0, 860.0]
LWD  = [  10.0, -640.0, 430.0]
LWS  = [  20.0, -622.0, 655.0]
UPS  = [  37.0, -580.0, 835.0]
LLF  = [  -2.0, -395.0, 212.0]
LLR  = [ 300.0, -370.0, 218.0]
ROB  = [ 135.0, -712.0, 282.0]
RIB  = [ 152.0, -350.0, 279.0]
SFF  = [ -70.0, -470.0, 260.0]
SFR  = [ 430.0, -340.0, 235.0]
ARB  = [ -20.0, -640.0, 560.0]
UPBBI = [ 40.0, -575.0, 960.0]
SAH  = [  95.0, -728.0, 295.0]
CLAMP = [  4.0, -655.0, 340.0]
[stiffness]
sff = [8000, 9000, 12000, 30, 30, 30]
sfr = [5000, 10000, 12000, 30, 30, 30]
upb = [3000, 3000, 1200, 4.0, 4.0, 0.05]
llf = [10000, 2000, 10000, 12, 1.5, 12]
llr = [1500, 600, 1500, 2.0, 1.0, 1.5]
[other]
"static.toe" = 0.05
"static.camber" = -0.50
"tyre.rate" = 220.0
"tyre.static_load" = 4300.0
"spring.rate" = 28.0
"damper.gas_force" = 0.0
"bump_stop.clearance" = 22.0
"rebound_stop.clearance" = 65.0
"arb.rate" = 22.0
"arb.radius" = 11.5
"steering.column" = 2070.0
"steering.rack_mm_per_rev" = 52.0
"scb.Tz" = 1.0
"steer_arm.radius" = 14.0
"strut.flexibility" = 0.0
"ride_height" = 0.0
[curves]
bump_stop = [[0,0],[10,300],[20,800],[30,1800],[40,3800],[50,7800],[60,14000]]
rebound_stop = [[0,0],[5,1500],[10,5000],[15,11000],[20,20000]]
"""
"""The reference's front_axle.toml in this project's names, and what the project adds to it."""
AXES = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")


def test_the_example_is_the_reference_axle() -> None:
    axle, reference = nominal(), tomllib.loads(REFERENCE)
    expected: dict[str, float] = dict(reference["other"])
    for name, point in reference["points"].items():
        expected |= {f"{name}.{a}": v for a, v in zip("xyz", point, strict=True)}
    for name, stiffness in reference["stiffness"].items():
        expected |= {f"{name}.stiffness.{a}": v for a, v in zip(AXES, stiffness, strict=True)}
        expected |= {f"{name}.{a}": 1.0 for a in AXES}
        expected |= {f"{name}.cubic.{a}": 0.01 if name == "llr" else 0.0 for a in AXES[:3]}
        expected |= {f"{name}.preload.{a}": 0.0 for a in AXES[:3]}
    for path, value in expected.items():
        assert parameter_value(axle, path) == value, path
        if not path.startswith(("arb", "steering", "scb", "ride_height", "tyre.static_load")):
            mirrored = -value if path.endswith(".y") else value
            assert parameter_value(axle, f"right.{path}") == mirrored, path
    for name, points in reference["curves"].items():
        read = [[axle.values[f"{name}.table.{c}{i}"] for c in "xy"] for i in range(len(points))]
        assert read == points
    lever = np.sqrt(79300.0 * np.pi * 11.5**4 / (2 * 900.0 * 22.0))
    assert lever == pytest.approx(331.7, abs=0.05)
    assert dict(axle.follow) == {"UPS": "UPB", "UPBBI": "UPB", "SAH": "ROB"}
    assert axle.effects == {}
    assert axle.half_track == 790.0


def test_every_entry_of_the_parameter_tables_is_a_parameter() -> None:
    points = (
        "LLF",
        "LLR",
        "LWB",
        "LWD",
        "LWS",
        "UPB",
        "UPBBI",
        "UPS",
        "RIB",
        "ROB",
        "SAH",
        "SFF",
        "SFR",
        "WLC",
    )
    expected = {f"{p}.{a}" for p in points for a in "xyz"}
    expected |= {f"{b}.{a}" for b in ("llf", "llr", "sff", "sfr", "upb") for a in AXES}
    expected |= {
        "scb.Tz",
        "strut.flexibility",
        "bump_stop.clearance",
        "rebound_stop.clearance",
        "spring.rate",
        "arb.radius",
        "steer_arm.radius",
        "static.toe",
        "static.camber",
        "ride_height",
    }
    for path in expected:
        assert np.isfinite(parameter_value(nominal(), path))
    listed = {p.path: p for p in design_parameters(nominal())}
    assert expected - set(listed) == {f"{p}.{a}" for p in ("UPS", "UPBBI", "SAH") for a in "xyz"}
    for p in listed.values():
        assert p.lower < p.upper
        assert p.lower <= p.nominal <= p.upper
        assert p.step > 0
        assert p.label
        assert p.unit in {"mm", "-", "N/mm", "deg"}
        if p.group == "HARDPOINTS":
            assert (p.lower, p.upper) == (p.nominal - 3, p.nominal + 3)
        if p.group == "BUSHINGS":
            assert (p.nominal, p.lower, p.upper) == (1.0, 0.5, 2.0)
    assert not listed["steer_arm.radius"].active
    assert all(p.active for path, p in listed.items() if path != "steer_arm.radius")


def test_a_freed_follower_becomes_a_parameter(tmp_path: Path) -> None:
    axle = read_axle(written(tmp_path, TEXT.replace('UPS = "UPB"\n', "")))
    assert {"UPS.x", "UPS.y", "UPS.z"} <= {p.path for p in design_parameters(axle)}


def written(folder: Path, content: str | bytes, name: str = "axle.toml") -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def edited(old: str, new: str) -> str:
    assert TEXT.count(old) >= 1, old
    return TEXT.replace(old, new, 1)


BAD = {
    "unknown hardpoint": ("LLF = [", "LFL = [", ["LFL", "LLF"]),
    "unknown section": ("[damper]", "[dampre]", ["dampre", 'Did you mean "damper"']),
    "unknown key": ("gas_force", "gas_farce", ["damper.gas_farce", 'Did you mean "gas_force"']),
    "missing key": ("static_load = 4300.0", "", ["tyre.static_load", "missing"]),
    "missing section": ("[spring]\nrate = 28.0", "", ["spring", "missing"]),
    "wrong unit of length": ('length = "mm"', 'length = "m"', ["units.length", "'m'", "'mm'"]),
    "wrong unit of stiffness": ('"Nm/deg"', '"Nm/rad"', ["rotational_stiffness", "Nm/deg"]),
    "nan": ("toe = 0.05", "toe = nan", ["static.toe", "finite"]),
    "inf": ("rate = 220.0", "rate = inf", ["tyre.rate", "finite"]),
    "nan in a hardpoint": ("LWB = [-8.0,", "LWB = [nan,", ["hardpoints.LWB", "finite"]),
    "zero stiffness": ("rate = 28.0", "rate = 0.0", ["spring.rate", "> 0"]),
    "negative stiffness": ("rate = 220.0", "rate = -220.0", ["tyre.rate", "> 0"]),
    "negative bushing": ("Fx = 1500.0", "Fx = -1500.0", ["bushings.llr.stiffness.Fx", "> 0"]),
    "missing bushing axis": (", Tz = 1.5 }", " }", ["bushings.llr", "Tz", "missing"]),
    "unknown bushing axis": ("Tz = 1.5 }", "Tz = 1.5, Qz = 1.0 }", ["bushings.llr", "Qz"]),
    "negative progression": ("cubic = { Fx = 0.01", "cubic = { Fx = -0.01", ["llr.cubic.Fx", ">= 0"]),
    "two coordinates": ("LWB = [-8.0, -748.0, 205.0]", "LWB = [-8.0, -748.0]", ["hardpoints.LWB", "3"]),
    "text for a number": ("rate = 28.0", 'rate = "28"', ["spring.rate", "'28'"]),
    "bool for a number": ("rate = 28.0", "rate = true", ["spring.rate", "True"]),
    "number for text": ('name = "Front axle, McPherson"', "name = 3", ["name"]),
    "wrong schema": ("doe_kc.axle/1", "doe_kc.axle/9", ["schema", "doe_kc.axle/9"]),
    "coincident arm points": (
        "LLR = [300.0, -370.0, 218.0]",
        "LLR = [-2.0, -395.0, 212.0]",
        ["LLF", "LLR", "apart"],
    ),
    "strut of zero length": (
        "LWD = [10.0, -640.0, 430.0]",
        "LWD = [40.0, -575.0, 860.0]",
        ["LWD", "UPB", "strut axis"],
    ),
    "tie rod of zero length": (
        "ROB = [135.0, -712.0, 282.0]",
        "ROB = [152.0, -350.0, 279.0]",
        ["RIB", "ROB", "tie rod"],
    ),
    "wrong side": ("LWB = [-8.0, -748.0", "LWB = [-8.0, 748.0", ["LWB", "y < 0"]),
    "wheel in the ground": ("-790.0, 310.0]", "-790.0, -310.0]", ["WLC.z", "ground"]),
    "strut upside down": ("860.0]", "400.0]", ["UPB", "LWD"]),
    "stop not monotone": ("[20.0, 800.0]", "[20.0, 200.0]", ["bump_stop", "monotone", "point 3"]),
    "stop deflection falls": ("[20.0, 800.0]", "[5.0, 800.0]", ["bump_stop", "monotone"]),
    "stop steeper than any part": ("[20.0, 800.0]", "[10.0000000000001, 800.0]", ["bump_stop", "steeper"]),
    "stop not from zero": (
        "curve = [[0.0, 0.0], [10.0",
        "curve = [[1.0, 0.0], [10.0",
        ["bump_stop", "[0, 0]"],
    ),
    "unknown load case": ("[load_cases.drive]", "[load_cases.drvie]", ["drvie", 'Did you mean "drive"']),
    "option of another load case": (
        "[load_cases.drive]",
        '[load_cases.drive]\ntechnique = "body"',
        ["drive", "technique"],
    ),
    "unknown technique": ('technique = "body"', 'technique = "boddy"', ["technique", "boddy"]),
    "too few steps": ("steps = 32", "steps = 1", ["load_cases.vertical.steps", ">= 2"]),
    "steps not whole": ("steps = 32", "steps = 3.5", ["load_cases.vertical.steps"]),
    "follows an unknown point": ('UPS = "UPB"', 'UPS = "UBP"', ["follow", "UBP"]),
    "follows a follower": ('SAH = "ROB"', 'SAH = "UPS"', ["follow", "SAH", "UPS"]),
}


@pytest.mark.parametrize("what", BAD)
def test_a_wrong_file_is_one_clear_message(what: str, tmp_path: Path) -> None:
    old, new, parts = BAD[what]
    path = written(tmp_path, edited(old, new))
    with pytest.raises(InputError) as caught:
        read_axle(path)
    message = str(caught.value)
    assert str(path) in message
    for part in parts:
        assert part in message, message
    assert caught.value.__suppress_context__ or caught.value.__cause__ is None


APPENDED = {
    "table not monotone": (
        "[bushings.llr.table]\nFx = [[-1.0, -100.0], [0.0, 0.0], [0.0, 5.0], [1.0, 100.0]]",
        ["llr", "table.Fx", "monotone"],
    ),
    "table falls": (
        "[bushings.llr.table]\nFx = [[-1.0, -100.0], [0.0, 0.0], [1.0, -10.0]]",
        ["llr", "table.Fx", "monotone"],
    ),
    "table does not span zero": (
        "[bushings.llr.table]\nFx = [[1.0, 100.0], [2.0, 200.0]]",
        ["llr", "table.Fx", "zero"],
    ),
    "table of one point": ("[bushings.llr.table]\nFx = [[0.0, 0.0]]", ["llr", "table.Fx", "two points"]),
    "empty table": ("[bushings.llr.table]\nFx = []", ["llr", "table.Fx", "two points"]),
    "unknown effect": ("[effects.hub_complaince]", ["hub_complaince", 'Did you mean "hub_compliance"']),
    "unknown effect key": ("[effects.hub_compliance]\ntoe_Nm_rad = 1.0", ["toe_Nm_rad", "toe_Nm_deg"]),
    "negative effect": ("[effects.hub_compliance]\ntoe_Nm_deg = -1.0", ["toe_Nm_deg", "> 0"]),
    "unknown right value": ('[right]\n"LLR.q" = 1.0', ["LLR.q", 'Did you mean "LLR.']),
    "right value of the whole axle": ('[right]\n"arb.rate" = 1.0', ["arb.rate", "whole axle"]),
    "right negative stiffness": ('[right]\n"llr.Fx" = -1.0', ["llr.Fx", "> 0"]),
    "right side on the left": ('[right]\n"LWB.y" = -748.0', ["LWB", "right", "y < 0"]),
    "right nan": ('[right]\n"LWB.y" = nan', ["right", "finite"]),
}


@pytest.mark.parametrize("what", APPENDED)
def test_a_wrong_addition_is_one_clear_message(what: str, tmp_path: Path) -> None:
    text, parts = APPENDED[what]
    path = written(tmp_path, f"{TEXT}\n{text}\n")
    with pytest.raises(InputError) as caught:
        read_axle(path)
    for part in [str(path), *parts]:
        assert part in str(caught.value), str(caught.value)


def test_several_wrong_keys_are_listed_together(tmp_path: Path) -> None:
    text = TEXT.replace("rate = 28.0", "rate = -1.0").replace("gas_force", "gas_farce")
    with pytest.raises(InputError) as caught:
        read_axle(written(tmp_path, text))
    assert "spring.rate" in str(caught.value)
    assert "gas_farce" in str(caught.value)


@pytest.mark.parametrize(
    ("content", "parts"),
    [
        (TEXT.replace("[damper]", "[damper", 1).encode(), ["not valid TOML", "line"]),
        (TEXT.replace("McPherson", "M\xe4c", 1).encode("latin-1"), ["UTF-8"]),
        (b"PK\x03\x04rest of a zip", ["Excel", "TOML"]),
        (b"\xd0\xcf\x11\xe0old excel", ["Excel"]),
        (b"", ["missing"]),
    ],
    ids=["syntax", "latin-1", "xlsx", "xls", "empty"],
)
def test_what_is_no_axle_file_at_all(content: bytes, parts: list[str], tmp_path: Path) -> None:
    path = written(tmp_path, content)
    with pytest.raises(InputError) as caught:
        read_axle(path)
    for part in [str(path), *parts]:
        assert part in str(caught.value)


def test_missing_file_and_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.toml: there is no such"):
        read_axle(tmp_path / "nowhere.toml")
    with pytest.raises(InputError, match="is a folder"):
        read_axle(tmp_path)
    with pytest.raises(InputError):
        read_axle(Path("a\0b.toml"))


def test_a_byte_order_mark_is_accepted_or_refused_in_words(tmp_path: Path) -> None:
    """Windows editors write it."""
    try:
        assert read_axle(written(tmp_path, b"\xef\xbb\xbf" + TEXT.encode())).name
    except InputError as error:
        assert "axle.toml" in str(error)


def test_right_overrides_are_chassis_coordinates(tmp_path: Path) -> None:
    axle = read_axle(written(tmp_path, f'{TEXT}\n[right]\n"LLR.y" = 374.0\n"llr.Fx" = 1.2\n'))
    assert parameter_value(axle, "right.LLR.y") == 374.0
    assert parameter_value(axle, "LLR.y") == -370.0
    assert parameter_value(axle, "right.llr.Fx") == 1.2
    assert parameter_value(axle, "llr.Fx") == 1.0


@pytest.mark.parametrize("size", [1.0, 1.3])
def test_the_strut_clamp_of_a_file_without_one_grows_with_the_axle(size: float) -> None:
    document = tomllib.loads(TEXT)
    own = document["hardpoints"].pop("CLAMP")
    for point in document["hardpoints"].values():
        point[:] = [size * v for v in point]
    axle = axle_from_document(document, source="test")
    clamp, lower, upper = (
        np.array([axle.values[f"{n}.{a}@L"] for a in "xyz"]) for n in ("CLAMP", "LWD", "UPB")
    )
    np.testing.assert_allclose(clamp, size * np.array(own), atol=2.0)
    np.testing.assert_allclose(np.cross(upper - lower, clamp - lower), 0.0, atol=1e-6)
    assert axle.values["WLC.z@L"] < clamp[2] < lower[2]


def test_load_case_options_arrive(tmp_path: Path) -> None:
    text = edited('technique = "body"\namplitude = 4.0', 'technique = "counter_phase"\namplitude = 50.0')
    text = text.replace("[load_cases.vertical]", '[load_cases.vertical]\ncontrol = "wheel"')
    text = text.replace("rack_mm_per_rev = 52.0", "rack_mm_per_rev = 60.0")
    cases = read_axle(written(tmp_path, text)).load_cases
    assert (cases["roll"].unit, cases["roll"].amplitude, cases["roll"].steps) == ("mm", 50.0, 24)
    assert cases["vertical"].control == "wheel"  # type: ignore[attr-defined]
    assert read_axle(written(tmp_path, text)).rack_mm_per_rev == 60.0


def test_a_tabulated_bushing_that_repeats_its_stiffness_is_that_bushing(tmp_path: Path) -> None:
    from doe_kc.solver.suite import solve

    table = "[bushings.sff.table]\nFy = [[-5.0, -45000.0], [0.0, 0.0], [5.0, 45000.0]]\n"
    table += "Tx = [[-5.0, -150.0], [0.0, 0.0], [5.0, 150.0]]\n"
    axle = read_axle(written(tmp_path, f"{TEXT}\n{table}"))
    a, b = solve(axle, ["lateral"], compiled=False), solve(nominal(), ["lateral"], compiled=False)
    for one, other in zip(a.cases["lateral"].branches, b.cases["lateral"].branches, strict=True):
        np.testing.assert_allclose(one.y, other.y, rtol=1e-9, atol=1e-7)


def test_a_flexible_steer_arm_is_the_effect(tmp_path: Path) -> None:
    axle = read_axle(written(tmp_path, edited("flexible = false", "flexible = true")))
    assert axle.topology.steer_arm
    soft = edited("radius = 14.0\nflexible = false", "radius = 9.0\nflexible = true")
    assert parameter_value(read_axle(written(tmp_path, soft)), "steer_arm.radius") == 9.0
    one_side = f'{soft}\n[right]\n"steer_arm.radius" = 11.0\n'
    assert parameter_value(read_axle(written(tmp_path, one_side)), "right.steer_arm.radius") == 11.0


def test_a_flexible_strut_is_in_the_equations(tmp_path: Path) -> None:
    axle = read_axle(written(tmp_path, edited("flexibility = 0.0", "flexibility = 0.5")))
    assert axle.topology.strut_bending
    assert parameter_value(axle, "strut.flexibility") == 0.5


def test_a_steering_input_drives_sixty_millimetres_of_rack_unless_the_file_says_otherwise() -> None:
    document = tomllib.loads(TEXT)
    del document["load_cases"]["steer"]
    document["steering"]["rack_mm_per_rev"] = 48.0
    axle = axle_from_document(document, source="test")
    assert axle.load_cases["steer"].amplitude == pytest.approx(60.0 / 48.0 * 360.0)


def test_effects_of_a_file_come_after_its_plain_axle() -> None:
    document = tomllib.loads(TEXT) | {
        "right": {"llr.Fx": 1.2},
        "effects": {"hub_compliance": {}, "asymmetry": {"LLR_R": 1.5}},
    }
    file, plain = plain_axle(document, source="test")
    assert (plain.effects, plain.values["llr.Fx@R"]) == ({}, 1.2)
    assert apply_effects(plain, file.effects, source="test") == axle_from_document(document, source="test")
