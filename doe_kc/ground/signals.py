"""Handlers of Ctrl-C and SIGTERM that a process forked from this one does not take over."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)

Handler = Callable[[int, FrameType | None], None]


def of_this_process(handler: Handler) -> Handler:
    """The handler here; in a forked process SIGTERM ends it with exit code 1, and SIGINT does nothing.

    A worker process has its parent's handlers until it sets its own, a few milliseconds later. A pool that
    has lost a worker ends the others at whatever age, and what their parent's handler raises would stand as
    their error in the terminal.
    """
    own = os.getpid()

    def mine(number: int, frame: FrameType | None) -> None:
        if os.getpid() == own:
            handler(number, frame)
        elif number == signal.SIGTERM:
            os._exit(1)

    return mine
