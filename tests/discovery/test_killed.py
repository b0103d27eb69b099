"""A search as a process of its own, killed in the middle, then run again."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

SEARCH = """
import json, os, signal, sys
from pathlib import Path
from doe_kc.discovery.bench import Bench
from doe_kc.discovery.discover import discover
from doe_kc.discovery.ledger import Ledger
from tests.discovery.cases import library, model

store, answer, lives = sys.argv[1], Path(sys.argv[2]), int(sys.argv[3])
put, fresh = Ledger.put, []

def counted(self, key, arrays):
    if len(fresh) == lives:
        os.kill(os.getpid(), signal.SIGKILL)
    fresh.append(key)
    put(self, key, arrays)

Ledger.put = counted
with Ledger(Path(store)) as ledger:
    found = discover(model("named"), library("hub_compliance"), Bench(ledger=ledger))
numbers = [list(found.fitted.z), [f.gain for f in found.findings], [h.gain for h in found.held_out]]
answer.write_text(json.dumps([found.verdict, *numbers]))
print(len(set(fresh)))
"""

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


def run(folder: Path, name: str, lives: int) -> subprocess.CompletedProcess[str]:
    """lives: results that it may store before it kills itself."""
    arguments = [str(folder / f"{name}.sqlite"), str(folder / f"{name}.json"), str(lives)]
    return subprocess.run(
        [sys.executable, "-c", SEARCH, *arguments], capture_output=True, text=True, timeout=120, check=False
    )


def test_killed_in_the_middle_it_goes_on_and_ends_the_same(tmp_path: Path) -> None:
    whole = run(tmp_path, "whole", 10**6)
    assert whole.returncode == 0, whole.stderr
    stored = int(whole.stdout)
    killed = run(tmp_path, "killed", stored // 2)
    assert killed.returncode == -signal.SIGKILL
    assert not (tmp_path / "killed.json").exists()
    again = run(tmp_path, "killed", 10**6)
    assert again.returncode == 0, again.stderr
    assert int(again.stdout) < stored
    assert (tmp_path / "killed.json").read_text() == (tmp_path / "whole.json").read_text()
    assert json.loads((tmp_path / "whole.json").read_text())[0] == "named"
