"""Checks of the Python API."""

from __future__ import annotations

from pathlib import Path

import doe_kc as kc
from tests.cli.runner import invoke, succeeds


def test_a_sound_study(folder: Path) -> None:
    result = kc.check(folder)
    assert result.sound and result.study is not None and result.errors.empty and result.warnings.empty
    assert result.lines[0] == "all sound" == succeeds("check", folder).out.splitlines()[-1]
    assert kc.check(result.study).lines == result.lines and "all sound" in result._repr_html_()


def test_every_fault_is_a_row(folder: Path, tmp_path: Path) -> None:
    text = (folder / "study.toml").read_text().replace('"axle.toml"', repr(str(folder / "axle.toml")))
    more = '[correlation]\nmethod = "egoo"\n[sampling]\nmethod = "lhss"\n'
    (tmp_path / "study.toml").write_text(text.replace('"rig"', repr(str(folder / "rig"))) + more)
    result = kc.check(tmp_path, out=tmp_path / "out")
    assert list(result.errors["kind"]) == ["method", "sampling"] and not result.sound
    assert set(result.to_frame()["severity"]) == {"error"} and "2 errors" in repr(result)
    outcome = invoke("check", tmp_path)
    assert outcome.code == 2 and all(m in outcome.err for m in result.errors["message"])


def test_a_study_that_cannot_be_read(tmp_path: Path) -> None:
    result = kc.check(tmp_path / "none")
    assert result.study is None and list(result.errors["kind"]) == ["study"]
    assert "study.toml" in result.errors.loc[0, "message"] or "none" in result.errors.loc[0, "message"]
