"""The cache of compiled kernels stays below its limit; what is in use stays."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from doe_kc.solver.cache_limit import CACHE_LIMIT, SAME_USE, note_use, remove_unused
from doe_kc.solver.library import CACHE_VARIABLE, build, find_compiler

DAY = 86_400.0


def filled(folder: Path, days: dict[str, float], size: int = 100) -> None:
    """Files of `size` bytes, used so many days ago."""
    for name, ago in days.items():
        path = folder / name
        path.write_bytes(b"x" * size)
        os.utime(path, (time.time() - DAY * ago,) * 2)


def test_below_the_limit_nothing_is_removed(tmp_path: Path) -> None:
    filled(tmp_path, {"a.so": 400.0, "b.txt": 1.0})
    remove_unused(tmp_path, 200)
    assert {p.name for p in tmp_path.iterdir()} == {"a.so", "b.txt"}


def test_what_has_not_been_used_for_longest_goes_first(tmp_path: Path) -> None:
    filled(tmp_path, {"a.so": 9.0, "b.npz": 3.0, "c.json": 30.0, "d.txt": 0.1, "e.so": 1.0, "f.lock": 90.0})
    remove_unused(tmp_path, 400)
    assert {p.name for p in tmp_path.iterdir()} == {"b.npz", "d.txt", "e.so", "f.lock"}


def test_a_use_counts_once_a_day(tmp_path: Path) -> None:
    filled(tmp_path, {"old.so": 3.0, "new.so": 0.5 * SAME_USE / DAY})
    old, new = tmp_path / "old.so", tmp_path / "new.so"
    before = new.stat().st_mtime
    note_use(old)
    note_use(new)
    assert time.time() - old.stat().st_mtime < 60.0
    assert new.stat().st_mtime == before
    note_use(tmp_path / "none.so")


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
def test_a_new_library_makes_room_for_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    old = tmp_path / "old.npz"
    with old.open("wb") as file:
        file.truncate(CACHE_LIMIT)  # sparse: takes no room on the disk
    os.utime(old, (0.0, 0.0))
    library = build({"one": "int one(void) { return 1; }"})
    assert library.exists() and not old.exists()
