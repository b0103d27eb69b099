"""The state that a car was measured in changes the model, not the axle file."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import design_parameters, with_values
from doe_kc.axle_file import read_axle
from doe_kc.ground.errors import InputError
from doe_kc.measurement import load_manifest
from doe_kc.measurement.rig_state import axle_in_state, rig_state
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.study import read_study
from doe_kc.workflow.discover import recorded
from doe_kc.workflow.measure import study_measurement
from tests.cli.runner import succeeds
from tests.reference import EXAMPLE, nominal

STUDY = """
name = "bar off"
axle = "axle.toml"
measurement = "rig"
pictures = "none"
[variables]
use = ["LLF.z", "llr.Fx", "spring.rate", "arb.radius"]
[correlation]
method = "gauss_newton"
budget = 6
"""


def barless_study(folder: Path, state: str = 'arb = "off"') -> Path:
    """A study whose records are those of its axle with a softer bushing, its anti-roll bar off."""
    rig = folder / "rig"
    rig.mkdir(parents=True)
    shutil.copy(EXAMPLE / "axle.toml", folder / "axle.toml")
    axle = with_values(nominal(), {"llr.Fx": 0.7, "LLF.z": 213.0}).changed({"arb.rate": 0.0})
    curves, rows = (
        curve_set(solve(axle, ["vertical", "roll"])),
        {"vertical": "pad_z [mm]", "roll": "roll [deg]"},
    )
    noise = np.random.default_rng(1)
    for case, head in rows.items():
        c = curves.cases[case]
        loop = np.r_[c.input[::-1], c.input[1:]]
        for run in range(2):
            names, columns = [head], [loop]
            for response in ("toe", "camber", "caster", "wc_x", "wc_y", "wc_z", "tyre_load"):
                unit = {"tyre_load": "N"}.get(response, "mm" if response.startswith("wc") else "deg")
                scatter = {"N": 2.0, "mm": 0.01, "deg": 0.001}[unit]
                for row, side in enumerate("LR"):
                    curve = c.mean["spin" if response == "caster" else response][row]
                    names.append(f"{response}_{side} [{unit}]")
                    columns.append(
                        np.interp(loop, c.input, curve) + scatter * noise.standard_normal(loop.size)
                    )
            text = (
                ",".join(names)
                + "\n"
                + "\n".join(",".join(f"{v:.6f}" for v in r) for r in np.array(columns).T)
            )
            (rig / f"{case}{run}.csv").write_text(text + "\n")
    records = "\n".join(f'{case} = ["{case}0.csv", "{case}1.csv"]' for case in rows)
    table = f"[state]\n{state}\n" if state else ""
    channels = '[channels]\npreset = "doe_kc"\nabsent = ["time"]\n'
    (rig / "test.toml").write_text(f'name = "barless"\n{table}\n{channels}\n[records]\n{records}\n')
    (folder / "study.toml").write_text(STUDY)
    return folder / "study.toml"


def test_the_model_is_simulated_without_the_bar(tmp_path: Path) -> None:
    study = read_study(barless_study(tmp_path))
    assert study.axle.values["arb.rate"] == 0.0
    assert study.as_designed(study.axle).values == nominal().values
    assert recorded(study.axle, study_measurement(study)).values["arb.rate"] == 0.0
    active = {p.path: p.active for p in design_parameters(study.axle)}
    assert not active["arb.radius"] and active["spring.rate"]


def test_a_connected_bar_is_the_default_and_changes_nothing(tmp_path: Path) -> None:
    study = read_study(barless_study(tmp_path, state=""))
    assert study.axle.values == nominal().values and not study.hidden
    assert axle_in_state(nominal(), study.state) is not None


def test_reduce_compares_without_the_bar(tmp_path: Path) -> None:
    off, on = barless_study(tmp_path / "off"), barless_study(tmp_path / "on", state='arb = "on"')
    gaps = {}
    for name, study in (("off", off), ("on", on)):
        succeeds("reduce", study)
        text = (study.parent / "out" / "compare" / "curves.csv").read_text().splitlines()
        head = text[0].split(",")
        rows = [dict(zip(head, line.split(","), strict=True)) for line in text[1:]]
        load = [r for r in rows if r["load_case"] == "roll" and r["response"] == "tyre_load"]
        gaps[name] = max(float(r[next(k for k in head if "rms" in k.lower())]) for r in load)
    assert gaps["off"] < 40.0 < 400.0 < gaps["on"], gaps


def test_a_correlated_axle_file_keeps_its_bar(tmp_path: Path) -> None:
    study = barless_study(tmp_path)
    succeeds("correlate", study, "--workers", 1)
    text = (tmp_path / "out" / "correlate" / "axle.toml").read_text()
    assert re.search(r"(?m)^rate = 22\.0 ", text)
    axle = read_axle(tmp_path / "out" / "correlate" / "axle.toml")
    assert axle.values["arb.rate"] == 22.0 and axle.values["arb.radius"] == 11.5
    assert axle.values["llr.Fx@L"] == pytest.approx(0.7, abs=0.12)


def test_a_state_of_another_word_is_refused(tmp_path: Path) -> None:
    study = barless_study(tmp_path, state='arb = "disconnected"')
    with pytest.raises(InputError, match=r"state.arb = 'disconnected', expected 'on' or 'off'"):
        load_manifest(tmp_path / "rig" / "test.toml")
    assert rig_state(tmp_path / "rig").arb == "on"
    with pytest.raises(InputError, match=r"state\.arb"):
        study_measurement(read_study(study))


def test_other_states_are_notes(tmp_path: Path) -> None:
    barless_study(tmp_path, state='arb = "off"\nengine = "running"\ntyre_pressure_bar = 2.3')
    assert rig_state(tmp_path / "rig").arb == "off"
