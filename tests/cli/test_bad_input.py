"""Bad input: one sentence that names the place and the remedy, exit code 2, nothing written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.runner import AXLE, fails, invoke, write_study

LATERAL = {"lateral": ("lateral.csv",)}


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        (["--set", "LLF.q=1"], r"unknown parameter 'LLF\.q'.*Did you mean \"LLF\.\w\""),
        (["--set", "LLG.x=1"], r"unknown parameter 'LLG\.x'.*Did you mean \"LL[FR]\.x\""),
        (["--set", "springrate=1"], r"unknown parameter.*Did you mean \"spring\.rate\""),
        (["--set", "left.spring=1"], "unknown parameter"),
        (["--set", "right.ride_height=1"], "belongs to the whole axle"),
        (["--set", "LLF.x@L=1"], "unknown parameter"),
        (["--set", "LLF.x"], "expected PATH=VALUE"),
        (["--set", ""], "expected PATH=VALUE"),
        (["--set", "=1"], "expected PATH=VALUE"),
        (["--set", "LLF.x="], "expected PATH=VALUE"),
        (["--set", "LLF.x-=1"], "unknown parameter|expected PATH=VALUE"),
        (["--set", "LLF.x==1"], "not a number|expected PATH=VALUE"),
        (["--set", "LLF.x=1 mm"], "expected PATH=VALUE"),
        (["--set", "LLF.x=wide"], "'wide' is not a number"),
        (["--set", "LLF.x=nan"], "LLF.x = nan, expected a finite number"),
        (["--set", "LLF.x=inf"], "finite"),
        (["--set", "spring.rate*=1e308"], "finite"),
        (["--set", "spring.rate=0"], r"spring\.rate = 0, expected a number > 0"),
        (["--set", "llr.Fx=-1"], r"llr\.Fx = -1, expected a number > 0"),
        (["--set", "strut.flexibility=-0.1"], "expected a number >= 0"),
        (["--effect", "bearing"], r"unknown effect 'bearing'; known are .*hub_compliance"),
        (["--effect", "hub_complience"], r"Did you mean \"hub_compliance\""),
        (["--effect", ""], "unknown effect ''"),
        (["--effect", "hub_compliance:camber=1"], r"no key 'camber'.*Did you mean \"camber_Nm_deg\""),
        (["--effect", "hub_compliance:camber_Nm_deg"], "expected key=value"),
        (["--effect", "hub_compliance:=5"], "expected key=value"),
        (["--effect", "hub_compliance:camber_Nm_deg=soft"], "expected a finite number"),
        (["--effect", "hub_compliance:camber_Nm_deg=-1"], "expected a number > 0"),
        (["--effect", "hub_compliance:camber_Nm_deg=[1,2]"], "expected a finite number"),
        (["--effect", "bushing_preload:LLR=[1,2]"], "expected a list of 3 numbers"),
        (["--effect", "bushing_preload:LLX=[1,2,3]"], "'LLX' is not a bushing"),
        (["--effect", "strut_friction:law=coulomb"], "expected one of dahl"),
        (["--effect", "left_right_asymmetry:scale=2"], "LLR_R"),
        (["--effect", "tie_rod_free_play:joints=ROB"], "ROB"),
        (["--case", "heave"], r"--case heave: is not a load case; known are .*vertical"),
        (["--case", "verticl"], r"Did you mean \"vertical\""),
        (["--roll", "pads"], "expected body or counter_phase"),
    ],
)
def test_simulate_refuses(tmp_path: Path, options: list[str], pattern: str) -> None:
    out = tmp_path / "out"
    outcome = fails(2, pattern, "simulate", AXLE, *options, "--out", out, "--json", tmp_path / "j.json")
    assert outcome.out == "" and not out.exists() and not (tmp_path / "j.json").exists()
    assert options[1] in outcome.err or "=" in options[1] or ":" in options[1]


@pytest.mark.parametrize(
    ("arguments", "pattern"),
    [
        (["simulate"], "Missing argument"),
        (["simulate", str(AXLE), "--nonsense"], "No such option"),
        (["influence", "x", "--workers", "0"], "workers"),
        (["influence", "x", "--seed", "-1"], "seed"),
        (["simulat"], "No such command"),
    ],
)
def test_wrong_usage_is_exit_code_2(arguments: list[str], pattern: str) -> None:
    outcome = invoke(*arguments)
    assert outcome.code == 2 and pattern in outcome.err and "Traceback" not in outcome.err


AXLE_DAMAGE: dict[str, tuple[Callable[[str], str], str]] = {
    "broken TOML": (lambda t: t.replace("[hardpoints]", "[hardpoints", 1), r"not valid TOML.*line \d+"),
    "no schema": (lambda _: "", "missing"),
    "NaN": (lambda t: t.replace("rate = ", "rate = nan #", 1), "finite"),
    "negative": (lambda t: t.replace("rate = ", "rate = -1 #", 1), "> 0|>= 0"),
    "text": (lambda t: t.replace("rate = ", 'rate = "much" #', 1), "much"),
    "unknown key": (lambda t: t + "\n[sprng]\nrate = 1\n", "sprng.*unknown"),
    "other schema": (lambda t: t.replace("doe_kc.axle/1", "doe_kc.axle/9"), "schema"),
}


@pytest.mark.parametrize("damage", AXLE_DAMAGE)
def test_a_bad_axle_file_is_named(tmp_path: Path, damage: str) -> None:
    change, pattern = AXLE_DAMAGE[damage]
    study = write_study(tmp_path)
    text = AXLE.read_text()
    assert change(text) != text
    (study / "axle.toml").write_text(change(text))
    for command in (["simulate", study / "axle.toml"], ["check", study], ["influence", study]):
        outcome = fails(2, pattern, *command)
        assert str(study / "axle.toml") in outcome.err


def test_files_that_are_not_there_or_not_files(tmp_path: Path) -> None:
    fails(2, "no such TOML file", "simulate", tmp_path / "none.toml")
    fails(2, "is a folder", "simulate", tmp_path)
    fails(2, r"study\.toml: there is no such TOML file", "check", tmp_path)
    fails(2, "cannot be read|no such", "simulate", AXLE / "below_a_file.toml")
    binary = tmp_path / "a.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    fails(2, "not UTF-8", "simulate", binary)
    binary.write_bytes(b"PK\x03\x04....")
    fails(2, "Excel workbook", "simulate", binary)


STUDY_DAMAGE = {
    "axle missing": ('name = "x"', "key axle is missing"),
    "no axle file": ('axle = "axel.toml"', r"axel\.toml: there is no such"),
    "axle is a folder": ('axle = "."', "is a folder"),
    "unknown key": ('axle = "axle.toml"\nmesurement = "rig"', r"mesurement is unknown.*\"measurement\""),
    "schema key": ('axle = "axle.toml"\nshema = "x"', r"Did you mean \"schema\""),
    "other schema": ('axle = "axle.toml"\nschema = "doe_kc.study/2"', "doe_kc.study/1"),
    "window key": ('axle = "axle.toml"\n[windows]\nheave = 1', r"\[windows\] heave is not a load case"),
    "window near": ('axle = "axle.toml"\n[windows]\nverticle = 1', r"Did you mean \"vertical\""),
    "window zero": ('axle = "axle.toml"\n[windows]\nroll = 0', "windows.roll is 0, expected a number > 0"),
    "window narrow": ('axle = "axle.toml"\n[windows]\nroll = 0.01', "roll = 0.01 deg.*widen"),
    "window nan": ('axle = "axle.toml"\n[windows]\nroll = nan', "windows.roll is nan"),
    "glob": ('axle = "axle.toml"\n[influence]\nparameters = ["LLX.*"]', r"'LLX\.\*' matches no parameter"),
    "no glob": ('axle = "axle.toml"\n[influence]\nparameters = []', "parameters: the list is empty"),
    "glob text": ('axle = "axle.toml"\n[influence]\nparameters = "*"', "influence.parameters"),
    "influence key": ('axle = "axle.toml"\n[influence]\nparameter = ["*"]', r"\"parameters\""),
    "seed": ('axle = "axle.toml"\nseed = -1', "seed is -1, expected a number >= 0"),
    "seed text": ('axle = "axle.toml"\nseed = "a"', "seed is 'a'"),
    "broken": ("axle = ", "not valid TOML"),
}


@pytest.mark.parametrize("damage", STUDY_DAMAGE)
def test_a_bad_study_file_is_named(tmp_path: Path, damage: str) -> None:
    text, pattern = STUDY_DAMAGE[damage]
    study = write_study(tmp_path)
    (study / "study.toml").write_text(text + "\n")
    for command in ("check", "influence"):
        outcome = fails(2, pattern, command, study)
        assert str(study) in outcome.err
    assert not (study / "out").exists()


@pytest.mark.parametrize("command", ["reduce", "run"])
def test_a_study_without_measurement(tmp_path: Path, command: str) -> None:
    study = write_study(tmp_path)
    fails(2, r"study\.toml: names no measurement; add .*--measurement DIR", command, study)
    fails(2, "nowhere", command, study, "--measurement", tmp_path / "nowhere")
    assert not (study / "out").exists() or command == "run"


def lines(text: str) -> list[str]:
    return text.splitlines()


RECORD_DAMAGE: dict[str, tuple[Callable[[str], str | bytes], str]] = {
    "missing channel": (lambda t: t.replace("toe_L [deg]", "note [deg]", 1), "toe_L"),
    "wrong unit": (lambda t: t.replace("toe_L [deg]", "toe_L [kN]", 1), "kN"),
    "wrong unit of the input": (lambda t: t.replace("[N]", "[kN]", 1), "covers .*e.06.*check the unit"),
    "truncated": (lambda t: t[: t.rstrip().rfind(",") - 3], "row 5|last|513|columns|cells|values"),
    "no loop": (lambda t: "\n".join(lines(t)[:140]) + "\n", "loop|covers|expected"),
    "few samples": (lambda t: "\n".join([lines(t)[0], *lines(t)[1::60]]), "samples"),
    "empty": (lambda _: "", "empty|heading|no "),
    "not a number": (lambda t: t.replace("\n0.1,", "\nsoon,", 1), "soon"),
    "workbook": (lambda _: b"PK\x03\x04 not text", "Excel|workbook"),
}


@pytest.mark.parametrize("damage", RECORD_DAMAGE)
def test_a_bad_record_is_named(tmp_path: Path, damage: str) -> None:
    change, pattern = RECORD_DAMAGE[damage]
    study = write_study(tmp_path, records=LATERAL)
    record = study / "rig" / "lateral.csv"
    text = record.read_text()
    content = change(text)
    assert content != text
    record.write_bytes(content if isinstance(content, bytes) else content.encode())
    for command in ("check", "reduce"):
        outcome = fails(2, pattern, command, study)
        assert str(record) in outcome.err
    assert not (study / "out").exists()


def test_a_bad_manifest_is_named(tmp_path: Path) -> None:
    study = write_study(tmp_path, records=LATERAL)
    manifest = study / "rig" / "test.toml"
    text = manifest.read_text()
    for change, pattern in (
        (text.replace("lateral =", "laterl ="), r"Did you mean \"lateral\""),
        (text.replace("lateral.csv", "gone.csv"), r"gone\.csv"),
        (text.replace("[records]", "[record]"), "record"),
        (text.replace("-0.495", "nan"), "camber_deg"),
        ("", "name|records"),
        ("= 1", "TOML"),
    ):
        manifest.write_text(change)
        for command in ("check", "reduce", "influence"):
            fails(2, pattern, command, study)
    manifest.unlink()
    fails(2, r"test\.toml", "check", study)
