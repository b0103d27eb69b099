"""Where a campaign's runs take place."""

from __future__ import annotations

from concurrent.futures import Executor

from doe_kc.campaign.in_process import InProcess
from doe_kc.campaign.processes import Processes, available_cores


def in_process() -> Executor:
    """This process, one run after the other."""
    return InProcess()


def processes(workers: int | None = None) -> Executor:
    """Worker processes, default one per core; they begin with the first run. One worker is this process."""
    count = workers if workers is not None else available_cores()
    return Processes(count) if count > 1 else InProcess()


def dask(address: str) -> Executor:
    """The cluster behind a Dask scheduler; InputError without the extra `dask` or without an answer."""
    from doe_kc.campaign.dask_cluster import DaskCluster

    return DaskCluster(address)


def executor_for(workers: int | None = None, scheduler: str | None = None) -> Executor:
    """The cluster of a scheduler's address when there is one, else processes on this machine."""
    return dask(scheduler) if scheduler else processes(workers)
