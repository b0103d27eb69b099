"""`doe-kc sample` as commands and as processes that are killed, interrupted, and run twice at a time."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from doe_kc.campaign.store import read_store
from tests.campaign.test_curves_codec import assert_same
from tests.cli.runner import Outcome, assert_one_message, fails, leftovers, succeeds, write_study

COMMAND = [sys.executable, "-m", "doe_kc", "sample"]
TABLES = """
[variables]
use = ["LLF.z", "llr.Fx", "spring.rate"]
[sampling]
n = 6
"""
SLOW = """
import sys, time
from doe_kc.true_solver.own import AxleSolver
evaluate = AxleSolver.evaluate
def slow(*arguments):
    time.sleep(0.2)
    return evaluate(*arguments)
AxleSolver.evaluate = slow
from doe_kc.cli import main
main()
"""


def study_in(folder: Path, extra: str = TABLES) -> Path:
    """The tables go behind the study's own keys."""
    study = write_study(folder, parameters=["LLF.z"])
    file = study / "study.toml"
    file.write_text(file.read_text() + extra, encoding="utf-8")
    return study


def content(study: Path) -> dict[str, object]:
    """What a store holds but for clocks: key -> (parameters, status, reason, characteristics)."""
    with read_store(study / "out" / "store" / "evaluations.sqlite") as store:
        return {
            r.key: (r.parameters, r.status, r.packed.reason, r.packed.characteristics, r.origin)
            for r in store.records()
        }


def test_help_names_every_option(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "120")
    text = succeeds("sample", "--help").out
    names = ("method", "n", "seed", "workers", "scheduler", "out", "measurement", "json", "export")
    assert all(f"--{name}" in text for name in names)


def test_a_sample_and_the_same_again(tmp_path: Path) -> None:
    study = study_in(tmp_path / "study")
    first = succeeds("sample", study, "--workers", 1, "--json", tmp_path / "j.json")
    assert "6 designs (lhs): 6 run, 0 already there, 0 failed" in first.out
    document = json.loads((tmp_path / "j.json").read_text())
    assert (document["runs"], document["kept"], document["failed"], document["seed"]) == (6, 0, 0, 1)
    span = document["characteristics"]["vertical.ride_rate"]
    assert 15.0 < span["low"] < span["mean"] < span["high"] < 60.0 and span["unit"] == "N/mm"
    table = pd.read_csv(study / "out" / "sample" / "designs.csv")
    assert list(table["status"]) == ["ok"] * 6 and len(set(table["LLF.z"])) == 6
    assert table["vertical.ride_rate"].mean() == pytest.approx(span["mean"])

    slim = tmp_path / "slim"
    succeeds("sample", study, "--workers", 1, "--curves", "none", "--out", slim)
    without = pd.read_csv(slim / "sample" / "designs.csv")
    pd.testing.assert_frame_equal(without.drop(columns="seconds"), table.drop(columns="seconds"))
    (small,), (large,) = ((f / "store").glob("*.sqlite") for f in (slim, study / "out"))
    assert small.stat().st_size < large.stat().st_size / 2

    again = succeeds("sample", study, "--n", 6, "--export", "csv")
    assert "0 run, 6 already there" in again.out
    more = succeeds("sample", study, "--method", "one_at_a_time", "--seed", 3, "--workers", 2)
    assert "7 designs (one_at_a_time): 7 run, 0 already there" in more.out
    assert sorted(p.name for p in (study / "out" / "sample").iterdir()) == [
        "curves.csv",
        "designs.csv",
        "evaluations.csv",
    ]
    assert {entry[4] for entry in content(study).values()} == {"sample:lhs", "sample:one_at_a_time"}  # type: ignore[index]
    assert not leftovers(tmp_path)


def test_failures_are_grouped_and_the_run_is_a_success(tmp_path: Path) -> None:
    lines = ["LLF.z,LWB.z", "210,207", "210,2000", "210,2010", "211,207"]
    study = study_in(
        tmp_path,
        '[variables]\nuse = ["LLF.z", "LWB.z"]\n[[variables.change]]\nmatch = "LWB.z"\nrange = [200, 2100]\n'
        '[sampling]\nmethod = "table"\ntable = "designs.csv"\n',
    )
    (study / "study.toml").write_text(
        (study / "study.toml").read_text().replace("[200, 2100]", "[200.0, 2100.0]")
    )
    (study / "designs.csv").write_text("\n".join(lines))
    outcome = succeeds("sample", study, "--workers", 1)
    assert "4 designs (table): 4 run, 0 already there, 2 failed" in outcome.out
    assert outcome.out.count("no equilibrium") <= 2
    assert list(pd.read_csv(study / "out" / "sample" / "designs.csv")["status"]) == [
        "ok",
        "failed",
        "failed",
        "ok",
    ]


@pytest.mark.parametrize(
    ("extra", "options", "pattern"),
    [
        (TABLES, ["--method", "lhd"], r"--method: 'lhd' is no sampling method.*\"lhs\""),
        (TABLES + 'method = "x"\n', [], r"study\.toml: sampling\.method: 'x' is no"),
        (TABLES, ["--method", "table"], "needs a file"),
        (TABLES, ["--export", "xlsx"], "--export xlsx: expected csv or parquet"),
        (TABLES + 'table = "none.csv"\nmethod = "table"\n', [], r"none\.csv: there is no such table"),
        (TABLES + "levels = 1\n", [], r"sampling\.levels"),
        ('[solver]\ncommand = ["no_such_solver"]\n' + TABLES, [], "'no_such_solver' cannot be run"),
        ('[solver]\nload_cases = ["heave"]\n' + TABLES, [], "heave is no load case"),
    ],
)
def test_bad_input(tmp_path: Path, extra: str, options: list[str], pattern: str) -> None:
    fails(2, pattern, "sample", study_in(tmp_path, extra), *options)


def test_a_changed_axle_is_another_store(tmp_path: Path) -> None:
    study = study_in(tmp_path)
    succeeds("sample", study, "--n", 1)
    axle = study / "axle.toml"
    axle.write_text(axle.read_text().replace("rack_mm_per_rev = ", "rack_mm_per_rev = 1"))
    fails(2, r"evaluations\.sqlite: holds .*rack_mm_per_rev was .*--out", "sample", study, "--n", 1)
    succeeds("sample", study, "--n", 1, "--out", tmp_path / "other")


def started(study: Path, n: int) -> subprocess.Popen[str]:
    """A slow sample of n designs on two workers, once it has stored some."""
    arguments = ["sample", str(study), "--n", str(n), "--workers", "2"]
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW, *arguments], stdout=-1, stderr=-1, text=True, start_new_session=True
    )
    limit = time.monotonic() + 30.0
    while time.monotonic() < limit and process.poll() is None:
        time.sleep(0.02)
        if (study / "out" / "store" / "evaluations.sqlite").exists() and stored(study) >= 4:
            break
    return process


def stored(study: Path) -> int:
    try:
        return len(content(study))
    except Exception:  # not yet a store
        return 0


pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


def test_a_killed_sample_resumes_to_the_same_store(tmp_path: Path) -> None:
    study = study_in(tmp_path / "killed")
    process = started(study, 16)
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()
    kept = content(study)
    assert 4 <= len(kept) < 16
    assert_no_worker(process.pid)
    resumed = succeeds("sample", study, "--n", 16, "--workers", 2)
    assert f"{16 - len(kept)} run, {len(kept)} already there" in resumed.out

    whole = study_in(tmp_path / "whole")
    assert "16 run, 0 already there" in succeeds("sample", whole, "--n", 16, "--workers", 1).out
    assert content(study) == content(whole)
    files = [s / "out" / "store" / "evaluations.sqlite" for s in (study, whole)]
    with read_store(files[0]) as one, read_store(files[1]) as two:
        for key in kept:
            pair = [s.outcome(key, {}).curves for s in (one, two)]
            assert pair[0] is not None and pair[1] is not None
            assert_same(pair[0], pair[1])
    tables = [
        pd.read_csv(s / "out" / "sample" / "designs.csv").drop(columns="seconds") for s in (study, whole)
    ]
    pd.testing.assert_frame_equal(*tables)


def assert_no_worker(session: int) -> None:
    """Workers end when their parent is killed."""
    limit = time.monotonic() + 5.0
    while time.monotonic() < limit:
        states = [
            s.read_text().rpartition(")")[2].split() for s in Path("/proc").glob("[0-9]*/stat") if s.exists()
        ]
        if not [s for s in states if int(s[3]) == session and s[0] != "Z"]:
            return
        time.sleep(0.05)
    raise AssertionError("a worker outlives its parent")


def test_a_second_sample_is_turned_away_and_the_first_interrupted(tmp_path: Path) -> None:
    study = study_in(tmp_path)
    process = started(study, 60)
    fails(1, r"evaluations\.sqlite: another run is writing to this store", "sample", study, "--n", 3)
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=20)
    kept = stored(study)
    assert 4 <= kept < 60
    message = rf"interrupted; {kept} evaluations are kept in .*evaluations\.sqlite, the same command resumes"
    assert_one_message(Outcome(process.returncode, out, err), 1, message)
    assert_no_worker(process.pid)
