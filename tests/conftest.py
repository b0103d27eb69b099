"""How the tests share the cores: one thread for linear algebra, whose matrices are small, and a whole file
to a worker, so that what its tests have in common is computed once; the longest ones first."""

from __future__ import annotations

import functools
import gc
import os
import re
from collections.abc import Generator
from pathlib import Path

import hypothesis
import pytest
from _pytest.terminal import TerminalReporter
from threadpoolctl import threadpool_limits
from xdist.scheduler import LoadScopeScheduling

TESTS = Path(__file__).parent

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")
threadpool_limits(1)
hypothesis.settings.register_profile("same examples in every run", derandomize=True, database=None)
hypothesis.settings.load_profile("same examples in every run")


def pytest_configure(config: pytest.Config) -> None:
    """Name the mark of tests that open a page in a browser."""
    config.addinivalue_line("markers", "browser: opens a page in headless Chromium")


SMALL_CARS = "small cars"
"""Of all files whose tests look at what is found in the small cars: each car is searched once."""
OF_SMALL_CARS = re.compile(r"discovery\.cases|chain_cases")
LONGEST = (
    SMALL_CARS,
    "cli/test_correlate.py",
    "benchmarks_discovery/test_quick_subset.py",
    "effects/test_hypotheses.py",
    "reports/test_correlation_reports.py",
    "solver/test_sensitivity.py",
    "correlation/test_methods.py",
)
"""They start first, so that no worker is left with one of them at the end."""


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_collection() -> Generator[None, object, object]:
    """Leave modules and items, which stay until the end, out of every search for garbage."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


class FileScheduling(LoadScopeScheduling):
    """Distribution by files, those of the small cars as one, in the order of collection."""

    def _split_scope(self, nodeid: str) -> str:
        return group_of(self.config.rootpath / nodeid.split("::")[0])


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> FileScheduling | None:
    """Distribute by files where no other way is asked for."""
    if config.getvalue("dist") != "load":
        return None
    config.option.loadscopereorder = False
    return FileScheduling(config, log)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Put the longest files first where several processes share them."""
    if hasattr(config, "workerinput"):
        items.sort(key=lambda item: rank_of(group_of(item.path)))


@functools.cache
def group_of(file: Path) -> str:
    """The file, relative to this folder, or what it is part of."""
    if OF_SMALL_CARS.search(file.read_text(encoding="utf-8")):
        return SMALL_CARS
    return file.relative_to(TESTS).as_posix()


def rank_of(group: str) -> int:
    """Place in the order of starting."""
    return LONGEST.index(group) if group in LONGEST else len(LONGEST)


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Say how many tests of the pages ran: without a browser they are skipped."""
    ran, skipped = (
        sum(
            "browser" in getattr(report, "keywords", ())
            for kind in kinds
            for report in terminalreporter.stats.get(kind, [])
        )
        for kinds in (("passed", "failed", "error"), ("skipped",))
    )
    if ran or skipped:
        terminalreporter.write_line(f"tests of pages in a browser: {ran} ran, {skipped} skipped")
