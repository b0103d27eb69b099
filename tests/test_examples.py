"""The shipped example: where it lies, what a copy holds, what is refused."""

from __future__ import annotations

import errno
import shutil
from pathlib import Path

import pytest

from doe_kc import examples
from doe_kc.examples import copy_example, example_folder
from doe_kc.ground.errors import InputError, RunError
from doe_kc.workflow.check import check_study
from tests.reference import EXAMPLE


def test_the_example_is_that_of_the_source_tree() -> None:
    assert example_folder().samefile(EXAMPLE)


def test_a_copy_is_a_sound_study(tmp_path: Path) -> None:
    files = copy_example(tmp_path / "new")
    assert files == sorted(files) and all(f.is_file() for f in files)
    assert {"study.toml", "axle.toml", "test.toml", "vertical.csv"} <= {f.name for f in files}
    checked = check_study(tmp_path / "new")
    manifest = checked.manifest
    assert manifest is not None and not checked.errors and not checked.warnings
    assert manifest.name == "car_a" and sum(map(len, manifest.records.values())) == 24
    named = {entry for entries in manifest.records.values() for entry in entries}
    assert named == {f.name for f in files if f.suffix == ".csv"}


def test_results_are_not_copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "package"
    source = package / "_examples" / "front_axle"
    (source / "out").mkdir(parents=True)
    (source / "out" / "old.csv").touch()
    (source / "study.toml").touch()
    monkeypatch.setattr(examples, "__file__", str(package / "examples.py"))
    assert example_folder() == source
    assert [f.name for f in copy_example(tmp_path / "new")] == ["study.toml"]


def test_only_an_empty_folder_is_filled(tmp_path: Path) -> None:
    (tmp_path / "mine").touch()
    for target in (tmp_path, tmp_path / "mine"):
        with pytest.raises(InputError, match="exists and is not an empty folder; name another one"):
            copy_example(target)
    assert [p.name for p in tmp_path.iterdir()] == ["mine"]


def test_what_cannot_be_written_is_one_short_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_source: str, target: str, **_options: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", target)

    monkeypatch.setattr(shutil, "copyfile", full)
    with pytest.raises(RunError, match="No space left on device") as caught:
        copy_example(tmp_path / "new")
    assert str(tmp_path / "new") in str(caught.value) and len(str(caught.value)) < 400


def test_an_installation_without_example(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(examples, "__file__", str(tmp_path / "a" / "examples.py"))
    with pytest.raises(RunError, match="not part of this installation; reinstall"):
        example_folder()
