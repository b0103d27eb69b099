"""Worker processes that live as long as the campaign, and end with it however it ends."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from functools import partial
from multiprocessing.connection import wait
from multiprocessing.context import BaseContext
from types import TracebackType
from typing import Any, ParamSpec, TypeVar

from doe_kc.campaign.shared_arrays import called_with, shared_arguments
from doe_kc.ground.threads import find_libraries, limit_process

P = ParamSpec("P")
T = TypeVar("T")
GRACE = 2.0
"""Seconds that a worker without parent has to end what it started."""
LOOK = 1.0
"""Seconds between looks at the parent's id, where its end is not told otherwise."""


def available_cores() -> int:
    """Cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def start_context() -> BaseContext:
    """Fork on Linux, where it is safe: workers inherit the assembled equations; spawn elsewhere."""
    return multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")


class Processes(Executor):
    """A process pool, begun with the first task, that can be made anew after a worker was lost."""

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._pool: ProcessPoolExecutor | None = None

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Raises BrokenProcessPool after a worker was lost: see `renew`."""
        if self._pool is None:
            find_libraries()
            self._pool = ProcessPoolExecutor(self.workers, mp_context=start_context(), initializer=_begin)
        with warnings.catch_warnings():
            # Python 3.12 and later warn of a fork beside threads; a progress bar's holds nothing a task needs
            warnings.filterwarnings("ignore", r"This process .* is multi-threaded", DeprecationWarning)
            arguments = shared_arguments(args, kwargs)
            if arguments is None:
                return self._pool.submit(partial(_guarded, fn), *args, **kwargs)
            try:
                future = self._pool.submit(partial(_guarded, called_with), fn, arguments.content)
            except BaseException:
                arguments.close()
                raise
        future.add_done_callback(lambda _: arguments.close())
        return future

    def renew(self) -> None:
        """Other workers for the next task."""
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.shutdown(wait=True, cancel_futures=True)

    def abandon(self) -> None:
        """End the workers in mid-task; commands that they wait for end too."""
        for process in list((getattr(self._pool, "_processes", None) or {}).values()):
            process.terminate()
        self.renew()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Waits for what is under way, or ends it after an exception: nobody takes its results then."""
        if kind is None:
            self.shutdown()
        else:
            self.abandon()

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the workers; `submit` would begin anew."""
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.shutdown(wait=wait, cancel_futures=cancel_futures)


def _begin() -> None:
    """In a new worker: Ctrl-C is the parent's business, SIGTERM ends it, one thread is enough."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    limit_process()
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _guarded(fn: Callable[..., T], *args: Any, **kwargs: Any) -> T:
    """The task; a worker told to end in its middle ends, and so does a command that it waits for.

    Only then: outside a task the exception would be reported as an error of the pool.
    """
    try:
        signal.signal(signal.SIGTERM, _leave)
        return fn(*args, **kwargs)
    except SystemExit:
        os._exit(1)
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _leave(_signal: int, _frame: object) -> None:
    raise SystemExit(1)


def _end_with_parent() -> None:
    """A killed parent would leave its workers waiting for ever.

    Its sentinel tells its end at once on every system, yet not while a process that it started holds the
    other end open; a process without parent is given to another, so that its parent's id changes.
    """
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    while not wait([parent.sentinel], LOOK):
        if os.name == "posix" and os.getppid() != parent.pid:
            break
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(GRACE)
    os._exit(1)
