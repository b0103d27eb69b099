"""`doe-kc correlate` and `report` as commands, and as processes that are killed and resumed."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from doe_kc.axle_file import read_axle
from doe_kc.characteristics import reduce_all
from doe_kc.reports.correlation import figures as correlation_figures
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.study import read_study
from doe_kc.targets import build_targets, rate, score
from tests.cli.runner import Outcome, assert_one_message, fails, invoke, leftovers, succeeds, write_study

RECORDS = {"lateral": ("lateral.csv",), "brake": ("brake.csv",)}
TABLES = """
[variables]
use = ["LLF.z", "LLR.z", "llr.Fx", "llf.Fx", "spring.rate", "static.toe", "static.camber", "UPB.y"]
[correlation]
method = "{method}"
budget = {budget}
first = 4
"""
SLOW = """
import time
from doe_kc.true_solver.own import AxleSolver
evaluate = AxleSolver.evaluate
def slow(*arguments):
    time.sleep(0.1)
    return evaluate(*arguments)
AxleSolver.evaluate = slow
from doe_kc.cli import main
main()
"""

pytestmark = pytest.mark.usefixtures("undrawn")


def study_in(folder: Path, method: str = "ego", budget: int = 12, extra: str = "") -> Path:
    return write_study(folder, records=RECORDS, tables=TABLES.format(method=method, budget=budget) + extra)


@dataclass(frozen=True)
class Correlated:
    """A study after `correlate`, with its stores and results."""

    study: Path
    document: dict[str, Any]

    def copy(self, folder: Path) -> Path:
        """Another of the same, to change."""
        return Path(shutil.copytree(self.study, folder / "copy"))


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Correlated:
    """The study of `study_in` with its default options, correlated with one worker; not to be changed."""
    study = study_in(tmp_path_factory.mktemp("example"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(correlation_figures, "write_correlation_figures", lambda *_, **__: [])
        return Correlated(study, document_of(study))


def document_of(study: Path, *options: object) -> dict[str, Any]:
    file = study / "c.json"
    outcome = invoke("correlate", study, "--json", file, "--workers", 1, *options)
    assert outcome.code in (0, 1) and not outcome.err.count("doe-kc:"), outcome.err
    found: dict[str, Any] = json.loads(file.read_text())
    assert outcome.code == (1 if found["status"] == "not_usable" else 0)
    return found


def test_an_axle_that_is_not_usable_ends_with_code_1_and_is_written(tmp_path: Path) -> None:
    study = study_in(tmp_path, budget=1)
    outcome = invoke("correlate", study, "--json", tmp_path / "c.json", "--workers", 1)
    assert outcome.code == 1 and outcome.out.startswith("Not usable: No design was better")
    assert json.loads((tmp_path / "c.json").read_text())["status"] == "not_usable"
    assert {"axle.toml", "report.html", "run.json"} <= {p.name for p in (study / "out/correlate").iterdir()}
    assert invoke("report", study).code == 0


def test_the_document_holds_what_the_tables_say(example: Correlated) -> None:
    study, found = example.study, example.document
    assert found["method"] == "ego" and 1 < found["evaluations"] <= 12
    assert set(found) >= {
        *("method", "evaluations", "rating", "feasible", "mean_improvement_percent", "characteristics"),
        *("parameters", "axle", "seconds"),
    }
    names = {c["name"] for c in found["characteristics"]}
    assert "brake.brake_steer" in names and "vertical.bump_steer" not in names
    assert set(found["parameters"]) >= {"LLF.z", "static.toe"}
    assert found["parameters"]["static.toe"]["sd"] > 0
    files = {p.name for p in (study / "out" / "correlate").iterdir()}
    assert {"axle.toml", "report.html", "correlation.xlsx", "characteristics.csv", "run.json"} <= files
    assert not leftovers(study)


def test_the_best_axle_loads_back_to_its_rating(example: Correlated) -> None:
    folder, found = example.study, example.document
    study = read_study(folder)
    axle = read_axle(folder / "out" / "correlate" / "axle.toml")
    from doe_kc.workflow.measure import study_records

    reduced = study_records(study)
    assert reduced is not None
    curves = curve_set(solve(axle))
    targets = build_targets(study.axle, reduced.measurement, [], [], source="test")
    values = np.array(list(reduce_all(curves).values()))
    assert rate(targets, score(targets, values, curves)).total == pytest.approx(found["rating"], abs=1e-9)


def test_a_second_run_needs_no_evaluation_and_ends_the_same(example: Correlated, tmp_path: Path) -> None:
    study, first = example.copy(tmp_path), example.document
    count = stored(study)
    second = document_of(study)
    assert stored(study) == count
    elsewhere = {"seconds", "axle"}
    assert {k: v for k, v in first.items() if k not in elsewhere} == {
        k: v for k, v in second.items() if k not in elsewhere
    }


def test_workers_do_not_change_the_result(example: Correlated, tmp_path: Path) -> None:
    one, two = example.document, document_of(study_in(tmp_path), "--workers", 2)
    assert one["rating"] == two["rating"] and one["parameters"] == two["parameters"]


def test_another_seed_samples_elsewhere(tmp_path: Path) -> None:
    study = study_in(tmp_path, budget=4)
    document_of(study)
    document_of(study, "--seed", 7, "--out", tmp_path / "b")
    one, other = (
        pd.read_csv(out / "correlate" / "evaluations.csv")[["origin", "LLF.z", "UPB.y"]]
        for out in (study / "out", tmp_path / "b")
    )
    assert list(one["origin"]) == list(other["origin"])
    assert list(one["origin"][:3]) == ["baseline", "first-order step", "opening sample"]
    same = (one == other).all(axis=1)
    assert same[0] and same[1] and not same[2:].any()


def test_sampled_designs_are_known_and_not_counted(tmp_path: Path) -> None:
    study = study_in(tmp_path, budget=3)
    succeeds("sample", study, "--n", 12, "--workers", 1)
    count = stored(study)
    found = document_of(study)
    assert found["evaluations"] == 3 and stored(study) == count + 3
    alone = document_of(study_in(tmp_path / "alone", budget=3))
    assert found["rating"] > alone["rating"]


def test_variables_by_the_advice_of_the_influence_study(tmp_path: Path) -> None:
    tables = '[variables]\nuse = "selection"\n[correlation]\nmethod = "gauss_newton"\n'
    found = document_of(write_study(tmp_path, records=RECORDS, parameters=["LLF.?", "llr.F?"], tables=tables))
    assert set(found["parameters"]) < {"LLF.x", "LLF.y", "LLF.z", "llr.Fx", "llr.Fy", "llr.Fz"}
    assert found["parameters"]
    fails(2, 'use = "selection" needs a measurement', "correlate", unmeasured(tmp_path / "b", tables))


def unmeasured(folder: Path, tables: str) -> Path:
    extra = '[[characteristics]]\nmatch = "vertical.bump_steer"\ntarget = -5.0\n'
    return write_study(folder, tables=tables + extra)


def test_report_rates_anew_without_a_run(example: Correlated, tmp_path: Path) -> None:
    study, first = example.copy(tmp_path), example.document
    count = stored(study)
    again = study / "again.json"
    told = succeeds("report", study, "--json", again)
    assert "No run is stored" in told.out and not (study / "out" / "index.html").exists()
    same = json.loads(again.read_text())
    assert same["rating"] == first["rating"] and same["parameters"] == first["parameters"]
    file = study / "study.toml"
    file.write_text(file.read_text() + '\n[[characteristics]]\nmatch = "brake.*"\nlinear = 50.0\n')
    succeeds("report", study, "--json", again)
    other = json.loads(again.read_text())
    assert other["rating"] < first["rating"] and stored(study) == count
    assert other["evaluations"] == first["evaluations"]


def test_typed_targets_need_no_measurement(tmp_path: Path) -> None:
    extra = (
        '[[characteristics]]\nmatch = "vertical.bump_steer"\ntarget = -5.0\n'
        '[[characteristics]]\nmatch = "vertical.ride_rate"\ntarget = 27.0\nobjective = true\n'
    )
    study = write_study(tmp_path, tables=TABLES.format(method="ego", budget=14) + extra)
    found = document_of(study)
    assert found["rating"] > -0.05 and found["feasible"]
    fit = document_of(study, "--method", "gauss_newton")
    finals = {c["name"]: c["final"] for c in fit["characteristics"]}
    assert finals["vertical.ride_rate"] == pytest.approx(27.0, rel=0.02)


def test_pareto_hands_over_its_front(tmp_path: Path) -> None:
    study = study_in(tmp_path, method="pareto", budget=12)
    document_of(study)
    front = (study / "out" / "correlate" / "pareto_front.csv").read_text().splitlines()
    assert front[0].startswith("evaluation,") and front[0].endswith("rating,knee")
    assert sum(line.endswith("True") for line in front[1:]) == 1
    assert (study / "out" / "correlate" / "pareto_front.png").exists()


def test_set_first_is_reported_and_kept(tmp_path: Path) -> None:
    tables = TABLES.format(method="ego", budget=6).replace('"static.toe", "static.camber", ', "")
    study = write_study(
        tmp_path, records=RECORDS, tables=tables + 'set_first = ["static.toe", "static.camber"]\n'
    )
    found = document_of(study)
    assert len(found["steps"]) == 2 and "static.toe set to" in found["steps"][0]
    static = {c["name"]: c for c in found["characteristics"]}["static.toe"]
    assert static["baseline"] == pytest.approx(0.006, abs=2e-3)
    assert "static.toe" in found["parameters"]


def test_an_outside_solver_gives_the_same_correlation(tmp_path: Path) -> None:
    command = [sys.executable, str(tmp_path / "outside.py"), "{parameters}", "{folder}"]
    (tmp_path / "outside.py").write_text(
        "import json, subprocess, sys\n"
        "from pathlib import Path\n"
        "values = json.loads(Path(sys.argv[1]).read_text())['parameters']\n"
        "settings = [w for k, v in values.items() for w in ('--set', f'{k}={v!r}')]\n"
        "axle = str(Path(__file__).parent / 'axle.toml')\n"
        "call = [sys.executable, '-m', 'doe_kc', 'simulate', axle, *settings, '--out', sys.argv[2]]\n"
        "sys.exit(subprocess.run(call, stdout=subprocess.DEVNULL).returncode)\n"
    )
    solver = f"[solver]\ncommand = {json.dumps(command)}\ntwin = false\n"
    study = study_in(tmp_path, budget=4, extra=solver)
    found = document_of(study, "--workers", 2)
    own = document_of(study_in(tmp_path / "own", budget=4, extra="gradients = false\n"))
    assert found["rating"] == pytest.approx(own["rating"], rel=1e-5)
    assert all(p["sd"] is None for p in found["parameters"].values())
    fails(
        2,
        "gauss_newton needs exact sensitivities.*--method ego",
        "correlate",
        study,
        "--method",
        "gauss_newton",
    )
    insisting = study_in(tmp_path / "insisting", extra="gradients = true\n" + solver)
    fails(2, 'gradients = true needs exact sensitivities.*leave it at "auto"', "correlate", insisting)
    wrong = study_in(tmp_path / "wrong", extra='gradients = "yes"\n')
    fails(2, "correlation.gradients", "correlate", wrong)


def test_slopes_of_the_own_solver_are_used_unless_forbidden(example: Correlated, tmp_path: Path) -> None:
    auto = example.document
    forced = document_of(study_in(tmp_path / "true", extra="gradients = true\n"))
    without = document_of(study_in(tmp_path / "false", extra="gradients = false\n"))
    assert auto["rating"] == forced["rating"] != without["rating"]


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        (["--method", "egoo"], r"--method: 'egoo' is no correlation method.*Did you mean \"ego\""),
        (["--budget", "0"], "budget"),
        (["--measurement", "nowhere"], "nowhere"),
    ],
)
def test_wrong_options(tmp_path: Path, options: list[str], pattern: str) -> None:
    outcome = invoke("correlate", study_in(tmp_path), *options)
    assert outcome.code == 2 and "Traceback" not in outcome.err
    import re

    assert re.search(pattern, outcome.err), outcome.err


@pytest.mark.parametrize(
    ("table", "pattern"),
    [
        ('[[characteristics]]\nmatch = "brake.brake_ster"', "brake.brake_steer"),
        ('[[variables.change]]\nmatch = "LLF.z"\nstart = 900.0', "start 900 is outside the bounds"),
        (
            '[[characteristics]]\nmatch = "*"\nobjective = false\nconstraint = false',
            "no characteristic has a target",
        ),
    ],
)
def test_wrong_studies(tmp_path: Path, table: str, pattern: str) -> None:
    fails(2, pattern, "correlate", study_in(tmp_path, extra=table + "\n"))


def test_a_store_of_another_axle(tmp_path: Path) -> None:
    study = study_in(tmp_path, budget=3)
    document_of(study)
    axle = study / "axle.toml"
    axle.write_text(axle.read_text().replace("rate = 28.0", "rate = 29.0", 1))
    fails(2, r"evaluations\.sqlite", "correlate", study)
    fails(2, r"evaluations\.sqlite", "report", study)


def test_report_without_a_correlation(tmp_path: Path) -> None:
    study = study_in(tmp_path)
    fails(2, "there is no correlation to report; run doe-kc correlate first", "report", study)
    record = study / "out" / "correlate" / "run.json"
    record.parent.mkdir(parents=True)
    record.write_text("{")
    fails(2, r"run\.json: is not valid JSON", "report", study)
    record.write_text("{}")
    fails(2, r"(?s)run\.json: key method is missing.*run doe-kc correlate again", "report", study)


def test_a_full_disk_keeps_what_was_evaluated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from doe_kc.ground.errors import RunError
    from doe_kc.workflow import write_correlation

    study = study_in(tmp_path, budget=4)

    def full(*_args: object, **_options: object) -> Path:
        raise RunError(f"{tmp_path}: cannot be written (No space left on device).")

    with monkeypatch.context() as patch:
        patch.setattr(write_correlation, "write_axle", full)
        fails(1, "No space left", "correlate", study)
    count = stored(study)
    assert count >= 4
    document_of(study)
    assert stored(study) == count


def stored(study: Path) -> int:
    with sqlite3.connect(study / "out" / "store" / "evaluations.sqlite") as connection:
        return int(connection.execute("SELECT count(*) FROM evaluations").fetchone()[0])


def started(study: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", SLOW, "correlate", str(study), "--workers", "1"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_ended_in_mid_run_it_resumes_to_the_same_result(
    example: Correlated, tmp_path: Path, number: signal.Signals
) -> None:
    study, count = study_in(tmp_path), stored(example.study)
    process = started(study)
    store = study / "out" / "store" / "evaluations.sqlite"
    deadline = time.monotonic() + 60.0
    while time.monotonic() < deadline and not (store.exists() and _rows(store) >= 6):
        time.sleep(0.05)
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    if number == signal.SIGINT:
        assert_one_message(
            Outcome(process.returncode, out, err), 1, "interrupted; .* kept.*, the same command"
        )
    kept = stored(study)
    assert 6 <= kept < count
    resumed = document_of(study)
    for key in ("rating", "parameters", "characteristics", "evaluations"):
        assert resumed[key] == example.document[key]
    assert stored(study) == count


def _rows(store: Path) -> int:
    try:
        with sqlite3.connect(f"file:{store}?mode=ro", uri=True) as connection:
            return int(connection.execute("SELECT count(*) FROM evaluations").fetchone()[0])
    except sqlite3.OperationalError:
        return 0


def test_a_target_out_of_reach_is_named(tmp_path: Path) -> None:
    extra = '[[characteristics]]\nmatch = "brake.brake_steer"\ntarget = 40.0\n'
    study = study_in(tmp_path, budget=8, extra=extra)
    outcome = succeeds("correlate", study, "--workers", 1)
    assert "brake.brake_steer: the target 40 deg/kN is out of reach" in outcome.out
    assert "No design within the bounds meets" in outcome.out


def test_constraints_in_conflict_are_named(tmp_path: Path) -> None:
    extra = (
        '[[characteristics]]\nmatch = "lateral.wc_lateral_disp"\ntarget = 0.30\n'
        '[[characteristics]]\nmatch = "lateral_offset.wc_lateral_disp"\ntarget = 0.05\n'
    )
    study = study_in(tmp_path, budget=8, extra=extra)
    outcome = invoke("correlate", study, "--workers", 1)
    assert outcome.code == 1 and outcome.out.startswith("Not usable: ")
    assert "No design within the bounds meets" in outcome.out
