"""Places that cannot be written: one sentence with the path, exit code 1, the old result kept."""

from __future__ import annotations

import errno
import json
import os
import shutil
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from doe_kc.ground import output
from doe_kc.ground.errors import RunError
from doe_kc.reports.drawing import style
from doe_kc.reports.render import workbook
from tests.cli.runner import (
    AXLE,
    Outcome,
    assert_one_message,
    fails,
    invoke,
    leftovers,
    succeeds,
    write_study,
)

ONE_CASE = ("simulate", AXLE, "--case", "brake")


class FullDisk:
    """Every file whose name contains `part` meets the end of the disk in the middle of its content."""

    def __init__(self, patch: pytest.MonkeyPatch, part: str) -> None:
        self.part = part
        for owner, name in ((pd.DataFrame, "to_csv"), (Path, "write_text"), (Path, "write_bytes")):
            patch.setattr(owner, name, self.failing(getattr(owner, name)))

    def failing(self, original: Any) -> Any:
        def write(owner: Any, *args: Any, **options: Any) -> Any:
            path = owner if isinstance(owner, Path) else args[0]
            if self.part not in str(path):
                return original(owner, *args, **options)
            with Path(path).open("w") as half:
                half.write("half of i")
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        return write


def assert_no_space(outcome: Outcome, path: Path) -> None:
    assert_one_message(outcome, 1, "cannot be written .No space left on device.; free disk space")
    assert str(path) in outcome.err


@pytest.mark.parametrize("name", ["curves.csv", "characteristics.csv", "figures.json"])
def test_full_disk_during_simulate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    options = ("--out", tmp_path, "--json", tmp_path / "figures.json")
    succeeds(*ONE_CASE, *options)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    FullDisk(monkeypatch, name)
    outcome = invoke(*ONE_CASE, "--set", "LLF.z+=1", *options)
    assert_no_space(outcome, tmp_path / name)
    assert (tmp_path / name).read_bytes() == before[name]
    assert not leftovers(tmp_path) and len(list(tmp_path.iterdir())) == 3


@pytest.mark.usefixtures("undrawn")
def test_full_disk_during_influence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = write_study(tmp_path, parameters=["LLF.z"])
    book = study / "out" / "influence" / "influence.xlsx"
    book.parent.mkdir(parents=True)
    book.write_bytes(b"the old workbook")
    with monkeypatch.context() as patch:
        FullDisk(patch, "influence.xlsx")
        assert_no_space(invoke("influence", study), book)
    assert book.read_bytes() == b"the old workbook" and not leftovers(tmp_path)

    def locked(_self: Path, _target: Path) -> None:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", locked)
        outcome = fails(1, "close the file in other programs", "influence", study)
    assert str(book) in outcome.err
    assert book.read_bytes() == b"the old workbook" and not leftovers(tmp_path)
    assert workbook.write_whole is output.write_whole


def test_full_disk_while_drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_args: Any, **_options: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(style, "write_png", full)
    study = write_study(tmp_path, records={"lateral": ("lateral.csv",)})
    old = tmp_path / "out" / "reduce" / "rig_lateral.png"
    old.parent.mkdir(parents=True)
    old.write_bytes(b"the picture of last time")
    outcome = fails(1, "No space left on device", "reduce", study)
    assert "rig_lateral.png" in outcome.err and not leftovers(tmp_path)
    assert old.read_bytes() == b"the picture of last time"


@pytest.mark.parametrize("option", ["--out", "--json"])
def test_a_place_below_a_file(tmp_path: Path, option: str) -> None:
    file = tmp_path / "file"
    file.write_text("mine")
    outcome = fails(1, "folder cannot be made .Not a directory.", *ONE_CASE, option, file / "a" / "b")
    assert str(file) in outcome.err and file.read_text() == "mine"
    fails(1, "cannot be (made|written)", *ONE_CASE, "--json", tmp_path)
    fails(1, "folder cannot be made .File exists.", *ONE_CASE, "--out", file)
    assert file.read_text() == "mine"


def test_a_studys_out_below_a_file(tmp_path: Path) -> None:
    study = write_study(tmp_path, records={"lateral": ("lateral.csv",)}, extra='out = "axle.toml/out"')
    for command in ("reduce", "run"):
        fails(1, r"axle\.toml/out.*Not a directory", command, study)
    write_study(tmp_path, records={"lateral": ("lateral.csv",)}, extra='out = "a\\u0000b"')
    fails(1, "folder cannot be made", "reduce", study)


def test_init_onto_a_full_disk_and_below_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("mine")
    fails(1, "the example cannot be written .Not a directory", "init", tmp_path / "file" / "below")

    def full(source: str, target: str, **_options: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), target)

    monkeypatch.setattr(shutil, "copyfile", full)
    outcome = fails(1, "the example cannot be written", "init", tmp_path / "new")
    assert "No space left" in outcome.err and len(outcome.err) < 400


def test_a_broken_pipe_is_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(*_args: object, **_options: object) -> None:
        raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))

    monkeypatch.setattr("typer.echo", gone)
    outcome = invoke("check", AXLE.parent)
    assert outcome.code == 1 and outcome.err == ""


def test_a_figure_that_is_not_finite_is_null(tmp_path: Path) -> None:
    text = output.write_json(tmp_path / "a.json", {"a": float("nan"), "b": [1.0, float("inf")]}).read_text()
    assert json.loads(text) == {"a": None, "b": [1.0, None]}


def test_memory_and_lost_workers_are_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def starved(*_args: object, **_options: object) -> None:
        raise MemoryError

    study = write_study(tmp_path)
    for error, pattern in ((starved, "out of memory; use fewer --workers"), (lost, "a worker process")):
        monkeypatch.setattr("doe_kc.cli.commands.influence.study_influence", error)
        fails(1, pattern, "influence", study)


def lost(*_args: object, **_options: object) -> None:
    raise RunError("a worker process ended.")
