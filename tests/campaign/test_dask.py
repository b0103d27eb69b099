"""A real Dask cluster of two worker processes, one of which is killed in mid-run."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import pytest

from doe_kc.campaign import executors
from doe_kc.campaign.executors import dask
from doe_kc.campaign.runner import Campaign
from doe_kc.ground.errors import InputError
from tests.campaign.toys import Toy, bump_steer, designs, pids_of, runs_of

ROOT = Path(__file__).parents[2]
MODULE = "distributed.cli"


def start(stack: ExitStack, program: str, *arguments: str) -> subprocess.Popen[str]:
    environment = {**os.environ, "DASK_DISTRIBUTED__ADMIN__EVENT_LOOP_MONITOR_INTERVAL": "1h"}
    process = subprocess.Popen(
        [sys.executable, "-m", f"{MODULE}.{program}", *arguments],
        cwd=ROOT,
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    stack.callback(end, process)
    return process


def end(process: subprocess.Popen[str]) -> None:
    process.kill()
    process.communicate()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, list[subprocess.Popen[str]]]]:
    """Address of a scheduler, and its workers."""
    pytest.importorskip("distributed", reason="the extra dask is not in")
    place = tmp_path_factory.mktemp("dask")
    file = place / "scheduler.json"
    with ExitStack() as stack:
        where = ["--scheduler-file", str(file)]
        start(stack, "dask_scheduler", *where, "--port", "0", "--no-dashboard")
        plain = ["--no-nanny", "--nthreads", "1", "--no-dashboard", "--local-directory", str(place)]
        workers = [start(stack, "dask_worker", *where, *plain) for _ in range(2)]
        yield address_of(file), workers


def address_of(file: Path) -> str:
    import json

    limit = time.monotonic() + 30.0
    while time.monotonic() < limit:
        if file.exists() and (text := file.read_text()):
            return str(json.loads(text)["address"])
        time.sleep(0.05)
    raise AssertionError("no scheduler")


def test_a_cluster_gives_what_this_process_gives_though_a_worker_is_killed(
    toy: Toy, tmp_path: Path, cluster: tuple[str, list[subprocess.Popen[str]]]
) -> None:
    address, workers = cluster
    slow = replace(toy, seconds=0.05, fails=(7.0,))
    with Campaign(slow, tmp_path / "s", scheduler=address) as campaign:
        campaign.evaluate(designs(8, 100.0), "before")
        threading.Timer(0.3, workers[0].send_signal, (signal.SIGKILL,)).start()
        found = campaign.evaluate(designs(30), "test")
        assert campaign.runs == 38
    assert workers[0].wait(10) == -signal.SIGKILL
    with Campaign(replace(toy, log=tmp_path / "here", fails=(7.0,)), workers=1) as alone:
        expected = alone.evaluate(designs(30), "test")
    assert [o.reason for o in found] == [o.reason for o in expected]
    assert bump_steer(found)[:6] == bump_steer(expected)[:6]
    assert bump_steer(found)[7:] == bump_steer(expected)[7:]
    assert os.getpid() not in pids_of(slow) and set(runs_of(slow)) >= {d["x"] for d in designs(30)}


def test_bad_input_comes_back_from_the_cluster(
    toy: Toy, cluster: tuple[str, list[subprocess.Popen[str]]]
) -> None:
    with (
        Campaign(toy, scheduler=cluster[0]) as campaign,
        pytest.raises(InputError, match="unknown parameter 'y'"),
    ):
        campaign.evaluate([{"y": 1.0}], "test")


def test_nobody_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed", reason="the extra dask is not in")
    monkeypatch.setattr(executors, "TIMEOUT", "1s")
    with pytest.raises(InputError, match=r"--scheduler tcp://127\.0\.0\.1:9: no Dask scheduler answers"):
        dask("tcp://127.0.0.1:9")
    with pytest.raises(InputError, match="no Dask scheduler answers"):
        dask("nonsense://x")


def test_the_extra_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"needs the extra `dask`; install doe-kc\[dask\]"):
        dask("tcp://127.0.0.1:9")
