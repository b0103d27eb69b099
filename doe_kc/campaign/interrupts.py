"""Ctrl-C and SIGTERM at times of our choosing: while waiting, not while storing."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any

from doe_kc.ground.signals import SIGNALS, of_this_process


class Interrupts:
    """Within it a signal raises KeyboardInterrupt at once inside `allowed`, else when that is next entered.

    Outside the main thread, where signals never arrive, it does nothing.
    """

    def __init__(self) -> None:
        self._arrived = False
        self._allowed = False
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            handle = of_this_process(self._handle)
            self._before = {number: signal.signal(number, handle) for number in SIGNALS}
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)
        if self._arrived and kind is None:
            raise KeyboardInterrupt

    def _handle(self, _signal: int, _frame: FrameType | None) -> None:
        self._arrived = True
        if self._allowed:
            raise KeyboardInterrupt

    @contextmanager
    def allowed(self) -> Iterator[None]:
        """A part that may be left at any point, and so may one within it."""
        before, self._allowed = self._allowed, True
        try:
            if self._arrived:
                raise KeyboardInterrupt
            yield
        finally:
            self._allowed = before
