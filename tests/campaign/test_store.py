"""The store: one writer, readers beside it, and one sentence for every way a file can be wrong."""

from __future__ import annotations

import re
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from doe_kc.campaign.runner import Campaign
from doe_kc.campaign.store import Store, open_store, read_store
from doe_kc.ground.errors import DoeKcError, InputError, RunError
from tests.campaign.toys import Toy, designs, runs_of


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "out" / "evaluations.sqlite"


def filled(toy: Toy, path: Path, count: int = 3) -> None:
    with Campaign(toy, path, workers=1) as campaign:
        campaign.evaluate(designs(count), "test")


def test_a_record_comes_back_whole(toy: Toy, path: Path) -> None:
    solver = replace(toy, fails=(2.0,))
    filled(solver, path)
    with read_store(path) as store:
        records = list(store.records())
        assert store.counts() == {"ok": 2, "failed": 1} and len(store) == 3
        assert [r.parameters for r in records] == designs(3)
        assert [r.status for r in records] == ["ok", "failed", "ok"]
        assert records[1].packed.reason == "no equilibrium at x = 2" and not records[1].packed.characteristics
        assert set(records[0].versions) == {"doe_kc", "python", "solver"}
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT[\d:.]+\+00:00", records[0].created)
        assert [r.key for r in store.records("te*")] == [r.key for r in records]
        assert not list(store.records("sample:*"))
        assert store.meta["schema"] == "1" and store.meta["fingerprint"] == toy.fingerprint()
        assert store.status("nothing") is None
        with pytest.raises(KeyError):
            store.outcome("nothing", {})


def test_nothing_is_left_beside_a_closed_store(toy: Toy, path: Path) -> None:
    filled(toy, path)
    with read_store(path) as store:
        assert len(store) == 3
    assert sorted(p.name for p in path.parent.iterdir()) == [path.name, path.name + ".lock"]


def test_another_solver_is_told_what_differs(toy: Toy, path: Path) -> None:
    filled(toy, path)
    before = path.read_bytes()
    with pytest.raises(InputError, match=r"evaluations\.sqlite: .*version was 1, is 2.*--out, or remove"):
        open_store(path, replace(toy, version="2"))
    assert path.read_bytes() == before


def test_fit_windows_are_no_other_solver(toy: Toy, path: Path) -> None:
    filled(toy, path)
    open_store(path, replace(toy, windows={"vertical": 5.0})).close()


def damaged(kind: str, good: bytes, path: Path) -> None:
    if kind == "text":
        path.write_text("no database\n" * 100)
    elif kind == "cut":
        path.write_bytes(good[: len(good) // 2])
    elif kind == "scrambled":
        path.write_bytes(good[:100] + b"\xa5" * (len(good) - 100))
    elif kind == "foreign":
        path.unlink()
        with sqlite3.connect(path) as other:
            other.execute("CREATE TABLE songs (title TEXT)")
        other.close()
    elif kind == "newer":
        with sqlite3.connect(path) as other:
            other.execute("UPDATE meta SET value = '2' WHERE name = 'schema'")
        other.close()


@pytest.mark.parametrize(
    ("kind", "pattern"),
    [
        ("text", "is not a store of evaluations, or is damaged"),
        ("cut", "is not a store of evaluations, or is damaged"),
        ("scrambled", "is not a store of evaluations, or is damaged"),
        ("foreign", "is a database, but no store of evaluations"),
        ("newer", r"was written by a newer doe_kc \(schema 2"),
    ],
)
def test_a_file_that_is_no_store_stays_as_it_is(toy: Toy, path: Path, kind: str, pattern: str) -> None:
    filled(toy, path, 8)
    damaged(kind, path.read_bytes(), path)
    before = path.read_bytes()
    with pytest.raises(InputError, match=pattern) as error:
        filled(toy, path, 8)
    assert str(path) in str(error.value) and "--out" in str(error.value)
    assert path.read_bytes() == before
    with pytest.raises(InputError, match=pattern), read_store(path) as store:
        list(store.records())


def test_an_empty_file_is_a_new_store(toy: Toy, path: Path) -> None:
    path.parent.mkdir()
    path.touch()
    filled(toy, path)
    assert len(runs_of(toy)) == 3


def test_damaged_curves_are_told_from_other_trouble(toy: Toy, path: Path) -> None:
    filled(toy, path)
    with sqlite3.connect(path) as other:
        other.execute("UPDATE evaluations SET curves = x'0102'")
    other.close()
    with pytest.raises(InputError, match=r"curves of evaluation \w{12} are damaged"):
        filled(toy, path)


def test_there_is_nothing_to_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"there is no such store; run doe-kc sample"):
        read_store(tmp_path / "none.sqlite")


def test_places_that_cannot_be_written(toy: Toy, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "evaluations.sqlite").mkdir()
    for place in (tmp_path / "file" / "s.sqlite", tmp_path / "evaluations.sqlite", Path("/proc/s.sqlite")):
        with pytest.raises(RunError, match="--out") as error:
            open_store(place, toy)
        assert str(place.parent) in str(error.value)


def test_a_second_writer_is_turned_away_and_a_reader_is_not(toy: Toy, path: Path) -> None:
    with Campaign(toy, path, workers=1) as first:
        first.evaluate(designs(1), "test")
        with pytest.raises(RunError, match="another run is writing to this store"):
            open_store(path, toy)
        with read_store(path) as reader:
            assert len(reader) == 1
            first.evaluate(designs(2), "test")
            assert len(reader) == 2
    filled(toy, path)
    assert runs_of(toy) == [1.0, 2.0, 3.0]


SECOND = """
import sys
from pathlib import Path
from doe_kc.campaign.store import open_store
from doe_kc.ground.errors import RunError
from tests.campaign.toys import Toy
try:
    open_store(Path(sys.argv[1]), Toy(Path("log")))
except RunError as error:
    print(error)
"""


def test_a_second_process_is_turned_away_though_workers_were_forked(toy: Toy, path: Path) -> None:
    with Campaign(toy, path, workers=2) as first:
        first.evaluate(designs(4), "test")
        done = subprocess.run(
            [sys.executable, "-c", SECOND, str(path)], capture_output=True, text=True, check=True
        )
    assert "another run is writing to this store" in done.stdout, done.stderr


def limited(store: Store, pages: int) -> None:
    store._connection.execute(f"PRAGMA max_page_count = {pages}")


def test_a_full_disk_keeps_what_was_stored(toy: Toy, path: Path) -> None:
    with open_store(path, toy) as store:
        limited(store, 20)
        with pytest.raises(RunError, match="the disk is full; the evaluations stored before are kept"):
            Campaign(toy, store, workers=1).evaluate(designs(60), "test")
        kept = len(store)
    assert 0 < kept < 60 and len(runs_of(toy)) <= kept + 2
    with Campaign(toy, path, workers=1) as campaign:
        campaign.evaluate(designs(60), "test")
        assert campaign.runs == 60 - kept


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 256 KiB."""
    place = tmp_path / "disk"
    place.mkdir()
    if shutil.which("mount") is None:
        pytest.skip("no mount")
    command = ["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(place)]
    if subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("not allowed to mount")
    yield place
    subprocess.run(["umount", "-l", str(place)], check=True)


def test_a_disk_that_is_really_full(toy: Toy, small_disk: Path) -> None:
    path = small_disk / "evaluations.sqlite"
    with pytest.raises(DoeKcError, match=r"the disk is full|cannot be read or written") as error:
        filled(toy, path, 200)
    assert isinstance(error.value, RunError) and str(path) in str(error.value)
    with read_store(path) as store:
        assert 0 < len(store) < 200
        for record in store.records():
            assert store.read(record, {}).curves is not None
