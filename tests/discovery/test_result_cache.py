"""The cache: exact, refuses what is no cache, and tells models apart."""

from __future__ import annotations

import sqlite3
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.discovery import result_cache
from doe_kc.discovery.linear_nuisances import LinearNuisances
from doe_kc.discovery.result_cache import (
    LOG_PAGES,
    PAGE_SIZE,
    WRITES_BEGUN,
    Arrays,
    ResultCache,
    fingerprint,
    key_of,
    packed,
    unpacked,
)
from doe_kc.ground.errors import InputError, RunError
from tests.discovery.cases import library, model


def test_arrays_come_back_exactly(tmp_path: Path) -> None:
    arrays = {"a": np.array([np.pi, np.inf, -0.0]), "b": np.zeros((0, 3))}
    with ResultCache(tmp_path / "sub" / "discovery.sqlite") as cache:
        assert cache.get("k") is None
        cache.put("k", arrays)
    with ResultCache(tmp_path / "sub" / "discovery.sqlite") as cache:
        found = cache.get("k")
    assert found is not None
    assert all(np.array_equal(found[k], v) and found[k].shape == v.shape for k, v in arrays.items())


def test_what_is_still_being_written_is_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And in the file once the cache is closed, however many wait."""
    slow, path = threading.Event(), tmp_path / "discovery.sqlite"

    def packed_late(arrays: Arrays) -> bytes:
        slow.wait(10.0)
        return packed(arrays)

    monkeypatch.setattr(result_cache, "packed", packed_late)
    with ResultCache(path) as cache:
        for k in range(WRITES_BEGUN):
            cache.put(str(k), {"a": np.array([float(k)])})
        assert cache.get("other") is None
        threading.Timer(0.05, slow.set).start()
        found = cache.get("2")
        assert found is not None and found["a"] == 2.0
        for k in range(WRITES_BEGUN, 3 * WRITES_BEGUN):
            cache.put(str(k), {"a": np.array([float(k)])})
    with ResultCache(path) as cache:
        every = [cache.get(str(k)) for k in range(3 * WRITES_BEGUN)]
    assert [float(one["a"][0]) for one in every if one is not None] == list(range(3 * WRITES_BEGUN))


def test_a_write_that_fails_is_told_by_what_follows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(_: Arrays) -> bytes:
        raise sqlite3.OperationalError("disk I/O error")

    with (
        pytest.raises(RunError, match=r"discovery\.sqlite"),
        ResultCache(tmp_path / "discovery.sqlite") as cache,
    ):
        monkeypatch.setattr(result_cache, "packed", refused)
        cache.put("k", {})


def test_a_jacobian_takes_less_than_half_of_its_bytes() -> None:
    """Columns of one magnitude each that do nothing in half of the load cases, digits at random."""
    rng = np.random.default_rng(1)
    jacobian = rng.normal(size=(2000, 40)) * 10.0 ** rng.uniform(-2, 2, 40)
    jacobian[:1000] = 0.0
    data = packed({"jacobian": jacobian, "shape": np.zeros((0, 3)), "number": np.array(2.0)})
    assert len(data) < 0.47 * jacobian.nbytes
    found = unpacked(data)
    assert found["jacobian"].tobytes() == jacobian.tobytes() and found["jacobian"].flags.c_contiguous
    assert found["shape"].shape == (0, 3) and float(found["number"]) == 2.0


def test_a_file_that_is_none_is_refused_with_a_remedy(tmp_path: Path) -> None:
    path = tmp_path / "discovery.sqlite"
    path.write_bytes(b"not a database, surely not one at all" * 40)
    with pytest.raises(InputError, match=r"discovery\.sqlite.*move it away"), ResultCache(path) as cache:
        cache.get("k")


def test_whatever_changes_the_answer_changes_the_fingerprint() -> None:
    base = model("none")
    curves = base.likelihood.curves
    other = replace(curves[0], value=curves[0].value + 1e-9)
    changed = [
        base.extended(library("hub_compliance")[0]),
        replace(base, left_out="lateral"),
        replace(base, axle=base.axle.changed({"tyre.static_load": 4301.0})),
        replace(base, likelihood=replace(base.likelihood, curves=(other, *curves[1:]))),
        replace(base, nuisances=LinearNuisances(np.zeros((base.likelihood.size, 1)))),
    ]
    prints = {fingerprint(m) for m in (base, *changed)}
    assert len(prints) == 1 + len(changed)
    assert fingerprint(base) == fingerprint(model("none"))


def test_keys_depend_on_every_part() -> None:
    z = np.array([1.0, 2.0])
    assert len({key_of("a", z), key_of("b", z), key_of("a", z + 1e-12), key_of("a")}) == 4


def test_a_new_store_has_large_pages_and_a_small_log(tmp_path: Path) -> None:
    with ResultCache(tmp_path / "discovery.sqlite") as cache:
        sizes = [cache._writer.execute(f"PRAGMA {p}").fetchone() for p in ("page_size", "wal_autocheckpoint")]
        assert sizes == [(PAGE_SIZE,), (LOG_PAGES,)]
