"""Where a campaign's runs take place: this process, worker processes, or workers of a Dask cluster."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any, ParamSpec, TypeVar

from doe_kc.campaign.processes import Processes, available_cores
from doe_kc.ground.errors import InputError

P = ParamSpec("P")
T = TypeVar("T")


class InProcess(Executor):
    """`submit` returns when the task is done. Ctrl-C passes through."""

    workers = 1

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """A future that is done."""
        future: Future[T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


TIMEOUT = "10s"
PER_WORKER = 4
"""Workers that each thread of the cluster counts as: twice as many tasks are under way, see `PendingRuns`, so
that no thread waits for the next one."""
PENDING_TASKS = 8
"""The same at least, for a cluster that is still starting its workers."""


class DaskCluster(Executor):
    """The workers behind a scheduler; the scheduler itself runs a task again when its worker is lost.

    lost: errors that mean "its workers were lost time and again".
    """

    def __init__(self, address: str) -> None:
        self._client, self.lost = _connected(address)
        self._executor: Executor = self._client.get_executor(pure=False)

    @property
    def workers(self) -> int:
        """Tasks that run at once at present, and some more so that a new worker finds work."""
        threads: list[int] = list(self._client.nthreads().values())
        return max(PENDING_TASKS, PER_WORKER * sum(threads))

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """A future on the cluster."""
        return self._executor.submit(fn, *args, **kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the cluster; its workers live on."""
        self._executor.shutdown(wait=wait and not cancel_futures)  # without waiting it cancels
        self._client.close()


def _connected(address: str) -> tuple[Any, tuple[type[BaseException], ...]]:
    """Client, and the errors of lost workers; InputError without the package or an answer."""
    try:
        distributed: Any = importlib.import_module("distributed")
    except ImportError:
        raise InputError(
            f"--scheduler {address}: needs the extra `dask`; install doe-kc[dask], or leave the option out."
        ) from None
    try:
        client = distributed.Client(address, timeout=TIMEOUT, set_as_default=False)
        return client, (distributed.scheduler.KilledWorker,)
    except (OSError, ValueError, TimeoutError) as error:
        raise InputError(
            f"--scheduler {address}: no Dask scheduler answers there ({str(error).splitlines()[0]}); start "
            "one with `dask scheduler`, and give its address, such as tcp://host:8786."
        ) from None


def in_process() -> Executor:
    """This process, one run after the other."""
    return InProcess()


def processes(workers: int | None = None) -> Executor:
    """Worker processes, default one per core; they begin with the first run. One worker is this process."""
    count = workers if workers is not None else available_cores()
    return Processes(count) if count > 1 else InProcess()


def dask(address: str) -> Executor:
    """The cluster behind a Dask scheduler; InputError without the extra `dask` or without an answer."""
    return DaskCluster(address)


def executor_for(workers: int | None = None, scheduler: str | None = None) -> Executor:
    """The cluster of a scheduler's address when there is one, else processes on this machine."""
    return dask(scheduler) if scheduler else processes(workers)
