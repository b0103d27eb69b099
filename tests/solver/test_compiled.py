"""Compiled kernels: the same figures as interpreted, and a machine that cannot compile still works."""

from __future__ import annotations

import ctypes
import logging
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.solver import library, suite
from doe_kc.solver.compiled import adaptive_kernel, compiled_kernel
from doe_kc.solver.library import CACHE_VARIABLE, CompileError, cache_folder, find_compiler, library_of
from doe_kc.solver.program_library import march_library
from doe_kc.solver.suite import library_for, solve
from tests.reference import nominal

needs_compiler = pytest.mark.skipif(find_compiler() is None, reason="no C compiler here")
TOPOLOGY = nominal().topology
TINY = {"one": "int one(void) { return 1; }\n"}
"""Sources that compile in no time."""


@pytest.fixture
def fresh(monkeypatch: pytest.MonkeyPatch):
    """No kernel in memory, and a notice that may come once."""
    monkeypatch.delenv("DOE_KC_COMPILE", raising=False)
    caches = (compiled_kernel, adaptive_kernel, march_library, suite._notice_once)
    for cache in caches:
        cache.cache_clear()
    yield
    for cache in caches:
        cache.cache_clear()


@needs_compiler
def test_compiled_and_interpreted_agree() -> None:
    a, b = solve(nominal(), compiled=True), solve(nominal(), compiled=False)
    assert a.equilibria == b.equilibria
    for case, expected in b.cases.items():
        for one, other in zip(a.cases[case].branches, expected.branches, strict=True):
            np.testing.assert_allclose(one.y, other.y, rtol=1e-9, atol=1e-7)
            np.testing.assert_allclose(one.x, other.x, rtol=1e-9, atol=1e-9)


@pytest.mark.usefixtures("fresh")
def test_without_a_compiler_everything_works_with_one_notice(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(library, "find_compiler", lambda: None)
    with caplog.at_level(logging.INFO, logger="doe_kc"):
        for _ in range(3):
            found = solve(nominal(), ["drive"])
    assert found.failure is None
    assert len(caplog.records) == 1
    assert "compiler" in caplog.text
    with pytest.raises(CompileError, match="no C compiler"):
        library_for(TOPOLOGY, True)


@needs_compiler
@pytest.mark.usefixtures("fresh")
def test_a_cache_that_cannot_be_written_falls_back_with_a_notice(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "file" / "cache"))
    assert cache_folder() == tmp_path / "file" / "cache"
    with caplog.at_level(logging.INFO, logger="doe_kc"):
        assert solve(nominal(), ["drive"]).failure is None
    assert len(caplog.records) == 1
    assert "cache" in caplog.text


@pytest.mark.usefixtures("fresh")
def test_a_compiler_that_fails_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    broken = tmp_path / "cc"
    broken.write_text("#!/bin/sh\necho 'license expired' >&2\nexit 1\n")
    broken.chmod(0o755)
    monkeypatch.setattr(library, "find_compiler", lambda: str(broken))
    with caplog.at_level(logging.INFO, logger="doe_kc"):
        assert solve(nominal(), ["drive"]).failure is None
    assert "license expired" in caplog.text


@needs_compiler
def test_a_library_is_built_once(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    first = library.build(TINY)
    stamp = first.stat().st_mtime_ns
    assert library.build(TINY) == first
    assert first.stat().st_mtime_ns == stamp
    assert library.build({"one": "int one(void) { return 2; }\n"}) != first
    assert [p.suffix for p in tmp_path.iterdir()] == [first.suffix] * 2
    assert ctypes.CDLL(str(first)).one() == 1


@needs_compiler
@pytest.mark.parametrize("keep", [0, 100, 0.3, 0.6, 0.9])
def test_a_truncated_library_is_replaced(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, keep: float
) -> None:
    """Loading it would kill the process, so its content is checked first."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    path = library.build(TINY)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(keep if keep >= 1 else keep * len(whole))])
    again = library.build(TINY)
    assert again.read_bytes()[:4] == whole[:4]
    assert ctypes.CDLL(str(again)).one() == 1
    assert list(tmp_path.iterdir()) == [again]


@needs_compiler
def test_a_library_is_found_again_without_its_sources(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    asked = []

    def sources() -> dict[str, str]:
        asked.append(1)
        return TINY

    first = library_of(TOPOLOGY, "test", sources, {})
    assert library_of(TOPOLOGY, "test", sources, {}) == first and len(asked) == 1
    library_of(replace(TOPOLOGY, hub=True), "test", sources, {})
    library_of(TOPOLOGY, "other", sources, {})
    assert len(asked) == 3
    monkeypatch.setattr(library, "_origins", lambda: "the package after a change")
    assert library_of(TOPOLOGY, "test", sources, {}) == first and len(asked) == 4


@needs_compiler
def test_of_two_that_need_a_library_one_builds_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    begun, go_on = threading.Event(), threading.Event()
    asked, paths = [], []

    def sources() -> dict[str, str]:
        asked.append(1)
        begun.set()
        go_on.wait(10.0)
        return TINY

    def work() -> None:
        paths.append(library_of(TOPOLOGY, "test", sources, {}))

    first, second = threading.Thread(target=work), threading.Thread(target=work)
    first.start()
    assert begun.wait(10.0)
    second.start()
    second.join(0.2)
    assert second.is_alive() and len(asked) == 1
    go_on.set()
    first.join()
    second.join()
    assert len(asked) == 1 and len(set(paths)) == 1 and len(paths) == 2
    assert not list(tmp_path.glob("*.lock"))


@needs_compiler
def test_a_damaged_library_is_not_found_again(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    first = library_of(TOPOLOGY, "test", lambda: TINY, {})
    first.write_bytes(first.read_bytes()[:100])
    second = library_of(TOPOLOGY, "test", lambda: TINY, {})
    assert ctypes.CDLL(str(second)).one() == 1
    for entry in tmp_path.glob("*.txt"):
        entry.write_text("nothing.so")
    assert library_of(TOPOLOGY, "test", lambda: TINY, {}) == second
