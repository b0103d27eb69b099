"""Writing: whole files or none, the same bytes for the same result."""

from __future__ import annotations

import errno
import json
import math
import os
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from doe_kc.ground.errors import RunError
from doe_kc.ground.output import make_folder, write_csv, write_json, write_whole


def names(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def test_a_file_is_written_with_its_folders(tmp_path: Path) -> None:
    path = tmp_path / "a" / "b" / "c.txt"
    assert write_whole(path, lambda p: p.write_text("new")) == path
    assert path.read_text() == "new" and names(path.parent) == ["c.txt"]
    write_whole(path, lambda p: p.write_text("newer"))
    assert path.read_text() == "newer"


@pytest.mark.parametrize(
    "error", [OSError(errno.ENOSPC, "No space left on device"), PermissionError(13, "Denied")]
)
def test_half_a_file_never_takes_the_place_of_a_whole_one(tmp_path: Path, error: OSError) -> None:
    path = tmp_path / "c.txt"
    path.write_text("old")

    def broken(beside: Path) -> None:
        assert path.read_text() == "old" and beside.parent == tmp_path
        beside.write_text("ha")
        raise error

    with pytest.raises(
        RunError, match=f"c.txt: cannot be written .{error.strerror}.; free disk space.*--out"
    ):
        write_whole(path, broken)
    assert path.read_text() == "old" and names(tmp_path) == ["c.txt"]


@pytest.mark.parametrize("error", [KeyboardInterrupt, RunError, ValueError])
def test_nothing_is_left_whatever_ends_the_writing(tmp_path: Path, error: type[BaseException]) -> None:
    def broken(beside: Path) -> None:
        beside.write_text("ha")
        raise error

    with pytest.raises(error):
        write_whole(tmp_path / "c.txt", broken)
    assert names(tmp_path) == []


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    target, link = tmp_path / "far" / "real.txt", tmp_path / "link.txt"
    target.parent.mkdir()
    target.write_text("old")
    link.symlink_to(target)
    write_whole(link, lambda p: p.write_text("new"))
    assert link.is_symlink() and target.read_text() == "new"
    assert names(target.parent) == ["real.txt"]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="POSIX")
def test_a_pipe_is_written_to_and_stays(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_json(pipe, {"a": 1})
        assert json.loads(os.read(reader, 1000)) == {"a": 1}
    finally:
        os.close(reader)
    assert pipe.is_fifo() and names(tmp_path) == ["pipe"]


def test_a_folder_in_the_place_of_a_file(tmp_path: Path) -> None:
    (tmp_path / "c").mkdir()
    with pytest.raises(RunError, match="cannot be written"):
        write_json(tmp_path / "c", {})
    assert names(tmp_path) == ["c"]


def test_folders(tmp_path: Path) -> None:
    assert make_folder(tmp_path / "a" / "b").is_dir()
    assert make_folder(tmp_path / "a" / "b").is_dir()
    (tmp_path / "file").touch()
    for path in (tmp_path / "file", tmp_path / "file" / "x", tmp_path / "a\0b"):
        with pytest.raises(RunError, match="folder cannot be made") as caught:
            make_folder(path)
        assert str(path) in str(caught.value) and caught.value.exit_code == 1


def test_json_has_no_number_that_is_none(tmp_path: Path) -> None:
    document = {
        "nan": math.nan,
        "numpy": {
            "inf": np.float64("inf"),
            "one": np.float64(1.5),
            "int": np.int64(3),
            "bool": np.bool_(True),
        },
        "list": [1, -math.inf, (2.0, math.nan)],
        "text": "Größe",
        3: None,
    }
    text = write_json(tmp_path / "a.json", document).read_text(encoding="utf-8")
    assert json.loads(text) == {
        "nan": None,
        "numpy": {"inf": None, "one": 1.5, "int": 3, "bool": True},
        "list": [1, None, [2.0, None]],
        "text": "Größe",
        "3": None,
    }
    assert "Größe" in text and text.endswith("}\n")


def test_csv_keeps_ten_digits(tmp_path: Path) -> None:
    frame = pd.DataFrame({"a": [1 / 3, 1e-12], "b": ["x", "y,z"]})
    path = write_csv(tmp_path / "a.csv", frame)
    assert path.read_text() == 'a,b\n0.3333333333,x\n1e-12,"y,z"\n'
    again = pd.read_csv(path)
    np.testing.assert_allclose(again["a"], frame["a"], rtol=1e-9)
