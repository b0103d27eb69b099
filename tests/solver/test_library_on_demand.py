"""When compiling pays: counted over processes, once, and begun anew where it fails."""

from __future__ import annotations

from pathlib import Path

import pytest

from doe_kc.solver import library_on_demand
from doe_kc.solver.library import CACHE_VARIABLE, CompileError, library_of
from doe_kc.solver.library_on_demand import LibraryOnDemand
from tests.reference import nominal

TOPOLOGY = nominal().topology
LIMIT, STEP = 1000, 100


@pytest.fixture(autouse=True)
def _small(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(library_on_demand, "OPERATIONS_BEFORE_COMPILING", LIMIT)
    monkeypatch.setattr(library_on_demand, "STORED_STEP", STEP)


def on_demand(made: list[str], kind: str = "test") -> LibraryOnDemand[str]:
    """One whose library is a word, written down each time it is made."""

    def make() -> str:
        made.append(kind)
        return kind

    return LibraryOnDemand(TOPOLOGY, kind, {}, make)


def test_the_work_of_several_processes_adds_up() -> None:
    made: list[str] = []
    for expected in (0.0, 0.3, 0.6):
        one = on_demand(made)
        assert one.share == expected
        for _ in range(3):
            assert one.library() is None
            one.count(STEP)
        one.count(STEP // 2)  # too little to be written down
    assert not made
    last = on_demand(made)
    assert last.share == 0.9 and last.library() is None
    last.count(STEP)
    assert last.library() == last.library() == "test" and made == ["test"]
    assert last.ready and last.share == 0.0


def test_two_at_a_time_do_not_overwrite_each_other() -> None:
    first, second = on_demand([]), on_demand([])
    first.count(3 * STEP)
    second.count(2 * STEP)
    assert second.share == 0.5
    first.count(STEP)
    assert first.share == on_demand([]).share == 0.6


def test_kinds_are_counted_apart() -> None:
    on_demand([]).count(5 * STEP)
    assert on_demand([], "another").share == 0.0


def test_where_it_fails_the_count_begins_anew() -> None:
    tried = []

    def make() -> str:
        tried.append(1)
        raise CompileError("license expired")

    one = LibraryOnDemand(TOPOLOGY, "test", {}, make)
    one.count(LIMIT)
    assert one.library() is None and one.library() is None and len(tried) == 1
    assert one.share == LibraryOnDemand(TOPOLOGY, "test", {}, make).share == 0.0


@pytest.mark.parametrize("content", ["", "many", "-5", "1.5"])
def test_a_damaged_count_is_none(content: str, tmp_path: Path) -> None:
    on_demand([]).count(5 * STEP)
    (entry,) = tmp_path.glob("*.json")
    entry.write_text(content)
    assert on_demand([]).share == 0.0


def test_what_the_cache_has_is_loaded_at_once() -> None:
    library_of(TOPOLOGY, "test", lambda: {"one": "int one(void) { return 1; }\n"}, {})
    made: list[str] = []
    assert on_demand(made).library() == "test" and made == ["test"]


def test_a_cache_that_cannot_be_written_counts_in_the_process(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "file" / "cache"))
    one = on_demand([])
    for _ in range(LIMIT // STEP):
        one.count(STEP)
    assert one.library() == "test"
