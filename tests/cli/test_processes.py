"""Commands as real processes: exit codes, both streams, Ctrl-C, workers that are killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.cli.runner import AXLE, Outcome, assert_one_message, leftovers, write_study

COMMAND = [sys.executable, "-m", "doe_kc"]
SLOW = """
import sys, time
from pathlib import Path
from doe_kc.true_solver.own import AxleSolver

evaluate = AxleSolver.evaluate

def slow(*arguments):
    folder.joinpath("running").touch()
    {what}
    return evaluate(*arguments)

AxleSolver.evaluate = slow
folder = Path(sys.argv.pop(1))
from doe_kc.cli import main
main()
"""
"""A command whose every evaluation does something first."""

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


def run(*arguments: object, **options: object) -> Outcome:
    done = subprocess.run(
        [*COMMAND, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        **options,  # type: ignore[call-overload]
    )
    return Outcome(done.returncode, done.stdout or "", done.stderr)


def test_two_bad_commands(tmp_path: Path) -> None:
    assert_one_message(run("simulate", AXLE, "--set", "LLF.q=1"), 2, "unknown parameter")
    (tmp_path / "file").touch()
    below = tmp_path / "file" / "out"
    assert_one_message(run("simulate", AXLE, "--case", "brake", "--out", below), 1, "Not a directory")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_results_to_a_full_device() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [*COMMAND, "check", str(AXLE.parent)], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert_one_message(Outcome(done.returncode, "", done.stderr), 1, "standard output: No space left")


def test_figures_to_standard_output() -> None:
    """A device is written to, not replaced."""
    outcome = run("simulate", AXLE, "--case", "brake", "--json", "/dev/stdout")
    assert outcome.code == 0, outcome.err
    assert '"characteristics"' in outcome.out and "brake.wind_up" in outcome.out
    assert Path("/dev/stdout").is_symlink() and not list(Path("/dev").glob(".stdout*"))


def start(folder: Path, what: str, *arguments: object) -> subprocess.Popen[str]:
    """A slow `influence`, in a session of its own, once its evaluations run."""
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW.format(what=what), str(folder), *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    await_true(lambda: (folder / "running").exists() or process.poll() is not None, 60.0)
    return process


def await_true(condition: object, seconds: float) -> None:
    end = time.monotonic() + seconds
    while not condition():  # type: ignore[operator]
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)


def session_is_empty(number: int) -> bool:
    """No process of the session is left, but for those that only wait to be collected."""
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, session = stat.read_text().rpartition(")")[2].split()[:4]
        except OSError:
            continue
        if int(session) == number and state != "Z":
            return False
    return True


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
@pytest.mark.parametrize(("workers", "number"), [(1, signal.SIGINT), (2, signal.SIGINT), (2, signal.SIGTERM)])
def test_an_interrupted_influence(tmp_path: Path, workers: int, number: signal.Signals) -> None:
    """Ctrl-C reaches the whole group, SIGTERM the command alone."""
    study = write_study(tmp_path / "study", parameters=["LL?.*", "spring.rate", "arb.radius", "tyre.rate"])
    old = study / "out" / "influence" / "influence.xlsx"
    old.parent.mkdir(parents=True)
    old.write_text("old")
    process = start(tmp_path, "time.sleep(0.1)", "influence", study, "--workers", workers)
    if number == signal.SIGINT:
        os.killpg(process.pid, number)
    else:
        process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert_one_message(
        Outcome(process.returncode, out, err), 1, "interrupted; results written so far are kept"
    )
    await_true(lambda: session_is_empty(process.pid), 10.0)
    assert old.read_text() == "old" and not leftovers(tmp_path)


def test_interrupted_while_it_starts() -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", IMPORTING, "simulate", str(AXLE)], stdout=-1, stderr=-1, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "importing\n"
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert_one_message(Outcome(process.returncode, out, err), 1, "interrupted")


IMPORTING = """
import sys, time
class Slow:
    def find_spec(self, name, path=None, target=None):
        if name == "numpy":
            print("importing", flush=True)
            time.sleep(30)
sys.meta_path.insert(0, Slow())
from doe_kc.cli import main
main()
"""


def test_a_killed_worker(tmp_path: Path) -> None:
    """As the kernel does when memory runs out."""
    study = write_study(tmp_path / "study", parameters=["LL?.*", "spring.rate", "arb.radius", "tyre.rate"])
    kill = "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"
    process = start(tmp_path, kill, "influence", study, "--workers", 2)
    out, err = process.communicate(timeout=60)
    outcome = Outcome(process.returncode, out, err)
    assert_one_message(outcome, 1, "a worker process was ended from outside.*fewer --workers")
    assert not (study / "out").exists()
