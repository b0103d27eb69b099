"""A search as a process of its own, killed in the middle, then run again in another."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from doe_kc.discovery.discover import discover
from doe_kc.discovery.result import Discovery
from doe_kc.discovery.result_cache import TABLE, WRITES_BEGUN, ResultCache
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import LATERAL, library, model

SEARCH = """
import os, signal, sys
from pathlib import Path
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.discovery.discover import discover
from doe_kc.discovery.result_cache import ResultCache
from tests.discovery.cases import LATERAL, library, model

put, fresh = ResultCache.put, []

def counted(self, key, arrays):
    if len(fresh) == int(sys.argv[2]):
        os.kill(os.getpid(), signal.SIGKILL)
    fresh.append(key)
    put(self, key, arrays)

ResultCache.put = counted
with ResultCache(Path(sys.argv[1])) as cache:
    discover(model("named", LATERAL), library("hub_compliance"), DiscoveryWorkers(cache=cache))
"""
"""Of a process that stores as many results as it is told, then kills itself."""

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


def results(store: Path) -> int:
    with sqlite3.connect(store) as connection:
        return int(connection.execute(f"SELECT count(*) FROM {TABLE}").fetchone()[0])


def searched(store: Path) -> Discovery:
    with ResultCache(store) as cache:
        return discover(model("named", LATERAL), library("hub_compliance"), DiscoveryWorkers(cache=cache))


def test_killed_in_the_middle_it_goes_on_and_ends_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = tmp_path / "whole.sqlite", tmp_path / "killed.sqlite"
    whole = searched(first)
    half = results(first) // 2
    call = [sys.executable, "-c", SEARCH, str(second), str(half)]
    killed = subprocess.run(call, capture_output=True, text=True, timeout=120, check=False)
    assert killed.returncode == -signal.SIGKILL, killed.stderr
    kept = results(second)
    assert half - WRITES_BEGUN <= kept <= half
    fresh: list[str] = []
    put = ResultCache.put
    monkeypatch.setattr(
        ResultCache, "put", lambda self, key, arrays: (fresh.append(key), put(self, key, arrays))
    )
    again = searched(second)
    assert len(set(fresh)) == results(first) - kept == results(second) - kept
    assert again.verdict == whole.verdict == "named"
    assert np.array_equal(again.fitted.z, whole.fitted.z)
    assert [f.gain for f in again.findings] == [f.gain for f in whole.findings]
    assert [h.gain for h in again.held_out] == [h.gain for h in whole.held_out]
