"""Workers end with their parent, and what they do with an exception of its."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from doe_kc.campaign.executors import processes
from doe_kc.ground.errors import RunError
from tests.cli.test_processes import await_true

PARENT = """
import os, sys, time
from functools import partial
from pathlib import Path
import numpy as np
from doe_kc.campaign.executors import processes
from doe_kc.reports.drawing.series import draw_series
from doe_kc.surrogate_models.models import gp
from doe_kc.surrogate_models.study import fit_study

folder = Path(sys.argv[2])

def busy(*_arguments, **_options):
    (folder / str(os.getpid())).touch()
    while True:
        sum(range(1000))

def pool():
    with processes(2) as executor:
        for done in [executor.submit(busy) for _ in range(4)]:
            done.result()

def pictures():
    draw_series([(folder / name, busy) for name in "abcd"], 2)

def surrogates():
    gp.GaussianProcess.fit = busy
    x = np.random.default_rng(1).random((40, 2))
    fit_study(x, x, models=["gp"], folds=4, workers=2)

{"pool": pool, "pictures": pictures, "surrogates": surrogates}[sys.argv[1]]()
"""


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_an_exception_ends_what_is_under_way() -> None:
    with pytest.raises(RunError, match="interrupted"), processes(2) as executor:
        begun = [executor.submit(time.sleep, 600.0) for _ in range(6)]
        raise RunError("interrupted")
    assert all(future.done() for future in begun)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
@pytest.mark.parametrize("work", ["pool", "pictures", "surrogates"])
@pytest.mark.parametrize("held", [False, True])
def test_workers_end_with_a_killed_parent(work: str, held: bool, tmp_path: Path) -> None:
    """held: another process still has the parent's pipes open, so that no end of file tells its end."""
    parent = subprocess.Popen([sys.executable, "-c", PARENT, work, str(tmp_path)])
    try:
        await_true(lambda: len(list(tmp_path.iterdir())) == 2 or parent.poll() is not None, 60.0)
        workers = [int(p.name) for p in tmp_path.iterdir()]
        assert len(workers) == 2 and all(alive(w) for w in workers)
        ends = pipes(parent.pid) if held else []
        holders = [os.open(f"/proc/{parent.pid}/fd/{end}", os.O_WRONLY) for end in ends]
    finally:
        parent.send_signal(signal.SIGKILL)
        parent.wait()
    await_true(lambda: not any(alive(w) for w in workers), 10.0)
    for fd in holders:
        os.close(fd)


def pipes(pid: int) -> list[str]:
    """Descriptors of the ends of pipes that a process writes to."""
    out = []
    for link in Path(f"/proc/{pid}/fd").iterdir():
        flags = Path(f"/proc/{pid}/fdinfo/{link.name}").read_text().split("flags:")[1].split()[0]
        if str(link.readlink()).startswith("pipe:") and int(flags, 8) & os.O_ACCMODE == os.O_WRONLY:
            out.append(link.name)
    return out
