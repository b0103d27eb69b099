"""One thread for linear algebra: many test processes share the cores, and the matrices are small."""

from __future__ import annotations

import os

import pytest
from _pytest.terminal import TerminalReporter
from threadpoolctl import threadpool_limits

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")
threadpool_limits(1)


def pytest_configure(config: pytest.Config) -> None:
    """Name the mark of tests that open a page in a browser."""
    config.addinivalue_line("markers", "browser: opens a page in headless Chromium")


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Say how many tests of the pages ran: without a browser they are skipped."""
    ran, skipped = (
        sum("browser" in report.keywords for kind in kinds for report in terminalreporter.stats.get(kind, []))
        for kinds in (("passed", "failed", "error"), ("skipped",))
    )
    if ran or skipped:
        terminalreporter.write_line(f"tests of pages in a browser: {ran} ran, {skipped} skipped")
