"""`check` and `simulate` warn of what no car has, and go on."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

from tests.cli.runner import AXLE, succeeds


def test_simulate_warns_and_solves(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING, logger="doe_kc"):
        outcome = succeeds("simulate", AXLE, "--case", "drive", "--set", "steering.rack_mm_per_rev=140")
    assert "drive." in outcome.out
    assert "load case steer moves the rack by 161.5 mm" in caplog.text


def test_check_warns_of_the_study_s_axle(tmp_path: Path) -> None:
    text = AXLE.read_text().replace("amplitude = 4.0", "amplitude = 40.0")
    (tmp_path / "axle.toml").write_text(text)
    study = tmp_path / "study.toml"
    study.write_text('schema = "doe_kc.study/1"\nname = "s"\naxle = "axle.toml"\n')
    assert "load case roll goes to 40 deg" in succeeds("check", study).err
