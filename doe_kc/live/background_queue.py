"""The long tasks of a page, one process after the other: cancelled on demand, ended with the server."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

from pydantic import ValidationError

from doe_kc.ground.errors import InputError
from doe_kc.live.tasks import (
    CANCELLED,
    NEWS,
    News,
    TaskFailure,
    TaskKind,
    TaskProgress,
    TaskRequest,
    TaskResult,
)

END_PATIENCE = 8.0
"""Seconds that a process has to end by itself; more than `background.GRACE_PERIOD`."""
Listen = Callable[[TaskRequest, News], None]


@dataclass(frozen=True)
class TaskStatus:
    """What the page says of a task. begun: monotonic s. seconds: since then, of a task that has ended."""

    task: TaskKind
    state: Literal["waiting", "running", "cancelling", "done", "failed"]
    words: str
    begun: float
    done: int = 0
    total: int = 0
    seconds: float = 0.0
    result: TaskResult | None = None

    @property
    def ended(self) -> bool:
        """Whether nothing more comes."""
        return self.state in ("done", "failed")

    @property
    def rate(self) -> float:
        """Steps a second; nan before the first."""
        passed = time.monotonic() - self.begun
        return self.done / passed if self.done and passed > 0.0 else float("nan")

    @property
    def left(self) -> float:
        """Seconds left at that rate, nan where it is not known."""
        return max(0, self.total - self.done) / self.rate if self.done else float("nan")

    def after(self, news: News) -> TaskStatus:
        """With what was told."""
        passed = time.monotonic() - self.begun
        match news:
            case TaskProgress(words=words, done=done, total=total):
                state: Literal["running", "cancelling"] = (
                    "cancelling" if self.state == "cancelling" else "running"
                )
                return replace(self, state=state, words=words, done=done, total=total)
            case TaskResult():
                words = news.lines[0] if news.lines else ""
                return replace(self, state="done", words=words, seconds=passed, result=news)
            case TaskFailure(reason=reason):
                return replace(self, state="failed", words=reason, seconds=passed)


class TaskProcess:
    """One process of `doe_kc.live.background`. ended: called, in a thread of its own, after its last news."""

    def __init__(self, request: TaskRequest, listen: Listen, ended: Callable[[], None]) -> None:
        self.request, self._listen, self._ended = request, listen, ended
        self._process = subprocess.Popen(
            [sys.executable, "-m", "doe_kc.live.background"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,  # Ctrl-C is the server's, which then ends it
        )
        assert self._process.stdin is not None
        self._process.stdin.write(request.model_dump_json().encode() + b"\n")
        self._process.stdin.flush()
        self._reader = threading.Thread(target=self._read, name="background", daemon=True)
        self._reader.start()

    @property
    def pid(self) -> int:
        """Of the process."""
        return self._process.pid

    def cancel(self) -> None:
        """Ask it to end; does not wait."""
        assert self._process.stdin is not None
        if not self._process.stdin.closed:
            self._process.stdin.close()

    def close(self) -> None:
        """End it, and wait for that."""
        self.cancel()
        try:
            self._process.wait(END_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
        if threading.current_thread() is not self._reader:
            self._reader.join(END_PATIENCE)

    def _read(self) -> None:
        assert self._process.stdout is not None and self._process.stdin is not None
        last: News | None = None
        for line in self._process.stdout:
            try:
                news = NEWS.validate_json(line)
            except ValidationError:
                continue
            if isinstance(news, TaskProgress):
                self._listen(self.request, news)
            else:
                last = news
        self._process.wait()
        self._process.stdout.close()
        cancelled = self._process.stdin.closed
        self.cancel()  # closes its input
        self._ended()
        code = self._process.returncode
        outside = f"the process of {self.request.task} was ended from outside ({code})."
        ending = TaskFailure(reason=CANCELLED if cancelled else outside)
        self._listen(self.request, last or ending)


class BackgroundQueue:
    """One process at a time, for all write to one store; one design and one task wait, the latest of each.

    listen: told all news, in another thread.
    """

    def __init__(self, listen: Listen) -> None:
        self._listen = listen
        self._lock = threading.Lock()
        self._process: TaskProcess | None = None
        self._waiting: dict[bool, TaskRequest] = {}
        self._ended = False

    @property
    def running(self) -> TaskRequest | None:
        """What is under way."""
        with self._lock:
            return None if self._process is None else self._process.request

    @property
    def pid(self) -> int | None:
        """Of the process that is under way."""
        with self._lock:
            return None if self._process is None else self._process.pid

    def put(self, request: TaskRequest) -> None:
        """Begin it, or let it wait in place of another of its kind; InputError for a task beside a task."""
        confirm = request.task == "confirm"
        with self._lock:
            under_way = None if self._process is None else self._process.request.task
            if not confirm and (False in self._waiting or under_way not in (None, "confirm")):
                raise InputError(f"{under_way or request.task} is still at work; cancel it, or wait.")
            self._waiting[confirm] = request
        self._next()

    def drop_confirmation(self) -> None:
        """Forget the design that waits: it is no longer what is set."""
        with self._lock:
            self._waiting.pop(True, None)

    def cancel_task(self) -> bool:
        """End correlate or discover; False where there is none."""
        with self._lock:
            waited = self._waiting.pop(False, None)
            process = self._process
            here = process is not None and process.request.task != "confirm"
            if here and process is not None:
                process.cancel()
        if waited is not None:
            self._listen(waited, TaskFailure(reason="cancelled before it began."))
        return here or waited is not None

    def close(self) -> None:
        """End everything, and wait for that."""
        with self._lock:
            self._ended = True
            self._waiting.clear()
            process = self._process
        if process is not None:
            process.close()

    def _next(self) -> None:
        """Begin what waits, a design before a task."""
        with self._lock:
            if self._process is not None or self._ended or not self._waiting:
                return
            request = self._waiting.pop(max(self._waiting))
            self._process = TaskProcess(request, self._listen, self._over)

    def _over(self) -> None:
        with self._lock:
            self._process = None
        self._next()
