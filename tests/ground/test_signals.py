"""A process forked from one with handlers of its own: its end says nothing."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="POSIX signals")

COMMAND = """
from doe_kc.cli import _app
_app._on_interrupt(_app._interrupted)
"""
WAITING_CAMPAIGN = """
from doe_kc.campaign.interrupts import Interrupts
interrupts = Interrupts()
interrupts.__enter__()
allowed = interrupts.allowed()
allowed.__enter__()
"""
NEW_WORKER = """
import os, signal, sys, time
{handlers}
here, there = os.pipe()
child = os.fork()
if not child:
    os.write(there, b"1")
    time.sleep(30.0)
    os._exit(0)
os.read(here, 1)
os.kill(child, signal.SIGINT)
os.kill(child, signal.SIGTERM)
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


@pytest.mark.parametrize("handlers", [COMMAND, WAITING_CAMPAIGN], ids=["command", "campaign"])
def test_a_worker_ended_before_it_has_begun_says_nothing(handlers: str) -> None:
    program = NEW_WORKER.format(handlers=handlers)
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (1, "", "")


def test_the_handler_in_its_own_process() -> None:
    program = """
import os, signal
from doe_kc.ground.signals import SIGNALS, of_this_process
for number in SIGNALS:
    signal.signal(number, of_this_process(lambda number, frame: print(number, frame is not None)))
    os.kill(os.getpid(), number)
"""
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True
    )
    assert ended.stdout.split() == ["2", "True", "15", "True"]
