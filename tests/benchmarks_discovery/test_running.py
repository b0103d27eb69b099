"""Keys are sealed before the analysis, answers kept one by one, and keys opened only as published."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from benchmarks.discovery import running, unsealing
from benchmarks.discovery.analyser import finite
from benchmarks.discovery.car import Car
from benchmarks.discovery.cases import Case, case_folder, cases, publish, published, unseal
from benchmarks.discovery.detectability import Detectability
from benchmarks.discovery.key import seal
from benchmarks.discovery.unsealing import scores
from doe_kc.axle import Axle
from doe_kc.correlation.likelihood import Likelihood


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[Case], Path]:
    chosen = cases(1, ["null", "library_deleted"], 5, "example")
    folder = tmp_path_factory.mktemp("run")
    publish(chosen, folder)
    return chosen, folder


def test_names_tell_nothing(run: tuple[list[Case], Path]) -> None:
    chosen, folder = run
    assert sorted(c.name for c in chosen) == ["case_0001", "case_0002"]
    seen = [p for c in chosen for p in case_folder(folder, c).rglob("*.toml")]
    assert len(seen) == 4
    assert not any(word in p.read_text() for p in seen for word in ("null", "deleted", "seed", "hidden"))


def test_published_hash_is_that_of_the_key(run: tuple[list[Case], Path]) -> None:
    chosen, folder = run
    known = published(folder)
    for case in chosen:
        car = unseal(case, folder)
        kept = (folder / "keys" / f"{case.name}.toml").read_text()
        assert known[case.name] == seal(kept) == car.seal


def test_a_key_that_changed_is_refused(run: tuple[list[Case], Path], tmp_path: Path) -> None:
    chosen, _ = run
    (tmp_path / "hashes.txt").write_text(f"{'0' * 64}  {chosen[0].name}.toml\n")
    with pytest.raises(RuntimeError, match="not the published one"):
        unseal(chosen[0], tmp_path)
    with pytest.raises(RuntimeError, match="not the published one"):
        publish(chosen[:1], tmp_path)


def _all_detectable(_: Axle, car: Car, __: Likelihood) -> dict[str, Detectability]:
    """In place of what takes seconds and has tests of its own."""
    return {effect.id: Detectability(9.0, "another", 0.0, ()) for effect in car.hidden}


def test_a_killed_run_goes_on(run: tuple[list[Case], Path], monkeypatch: pytest.MonkeyPatch) -> None:
    chosen, folder = run
    asked: list[list[str]] = []

    def fake(command: list[str], **_: Any) -> subprocess.CompletedProcess[str]:
        asked.append(command)
        if len(asked) == 2:
            raise KeyboardInterrupt
        Path(command[4]).write_text(json.dumps({"verdict": "none", "seconds": 2.0}))
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr(running.subprocess, "run", fake)
    monkeypatch.setattr(unsealing, "detectability", _all_detectable)
    with pytest.raises(KeyboardInterrupt):
        running.analyse_missing(chosen, folder, workers=1)
    running.analyse_missing(chosen, folder, workers=1)
    assert len(asked) == 3
    excluded = [c for c in asked if "--exclude" in c]
    assert {c[3].split("/")[-1] for c in excluded} == {c.name for c in chosen if c.suite != "null"}
    found = {s.suite: s for s in scores(chosen, folder)}
    assert found["null"].exact
    assert found["library_deleted"].missed
    assert found["library_deleted"].diagnosable is not None


def test_answers_are_json_without_infinities() -> None:
    assert finite({"a": [float("inf"), 1.0], 2: (float("nan"),)}) == {"a": [None, 1.0], "2": [None]}
