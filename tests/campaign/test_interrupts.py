"""Ctrl-C and SIGTERM: what has finished is stored, the message says how much, workers are gone."""

from __future__ import annotations

import os
import re
import signal
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from doe_kc.campaign.interrupts import Interrupts
from doe_kc.campaign.runner import Campaign
from doe_kc.ground.errors import RunError
from tests.campaign.toys import Toy, designs, pids_of, runs_of

pytestmark = pytest.mark.skipif(os.name == "nt", reason="POSIX signals")


def send_soon(number: signal.Signals, after: float) -> None:
    threading.Timer(after, os.kill, (os.getpid(), number)).start()


@pytest.mark.parametrize(("workers", "number"), [(1, signal.SIGINT), (2, signal.SIGINT), (2, signal.SIGTERM)])
def test_what_has_finished_is_kept(toy: Toy, tmp_path: Path, workers: int, number: signal.Signals) -> None:
    slow = replace(toy, seconds=0.05)
    handlers = [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)]
    send_soon(number, 0.4)
    with Campaign(slow, tmp_path / "s", workers=workers) as campaign:
        with pytest.raises(RunError, match=r"interrupted; \d+ evaluations are kept in .*resumes") as error:
            campaign.evaluate(designs(100), "test")
        kept = int(re.findall(r"\d+", str(error.value))[0])
        assert kept == len(campaign.store) == campaign.runs > 0
        assert kept <= len(runs_of(slow)) <= kept + 2 * workers
    assert [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)] == handlers
    with Campaign(replace(toy, log=tmp_path / "second"), tmp_path / "s", workers=workers) as campaign:
        campaign.evaluate(designs(kept + 5), "test")
        assert 5 <= campaign.runs < 5 + kept


def test_workers_in_a_long_run_end_at_once(toy: Toy, tmp_path: Path) -> None:
    slow = replace(toy, seconds=60.0)
    send_soon(signal.SIGTERM, 0.4)
    started = time.monotonic()
    with (
        Campaign(slow, tmp_path / "s", workers=2) as campaign,
        pytest.raises(RunError, match="0 evaluations"),
    ):
        campaign.evaluate(designs(4), "test")
    assert time.monotonic() - started < 5.0
    assert len(pids_of(slow)) == 2
    for pid in pids_of(slow):
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


def test_a_store_in_memory_starts_again(toy: Toy) -> None:
    send_soon(signal.SIGINT, 0.1)
    again = pytest.raises(RunError, match=r"interrupted; .* the same command starts again")
    with Campaign(replace(toy, seconds=0.05), workers=1) as campaign, again:
        campaign.evaluate(designs(100), "test")


def test_a_signal_while_storing_waits_for_the_next_wait() -> None:
    with pytest.raises(KeyboardInterrupt), Interrupts() as interrupts:
        os.kill(os.getpid(), signal.SIGTERM)
        stored = True
        with interrupts.allowed():
            stored = False
    assert stored
    with pytest.raises(KeyboardInterrupt), Interrupts():
        os.kill(os.getpid(), signal.SIGINT)


def test_a_part_within_another_leaves_it_allowed() -> None:
    with pytest.raises(KeyboardInterrupt), Interrupts() as interrupts, interrupts.allowed():
        with interrupts.allowed():
            pass
        os.kill(os.getpid(), signal.SIGINT)
        pytest.fail("goes on")


def test_other_threads_have_no_signals(toy: Toy) -> None:
    found: list[bool] = []

    def work() -> None:
        with Campaign(toy, workers=1) as campaign:
            found.append(campaign.evaluate(designs(1), "test")[0].failed)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == [False]
