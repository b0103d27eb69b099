"""One BLAS thread for many small matrices: more of them wait for each other, and round differently.

Measured on two busy cores: a fit of 80 designs takes 0.2 s with one thread, 5 to 13 s with two. A sum that
several threads share depends on their number in its last digits, and a search that follows them ends at
another design; so whatever computes limits the threads itself, whoever called it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from typing import Any

VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def set_thread_variables() -> None:
    """For a process that has not loaded a BLAS yet: none of its threads is begun. Does not replace
    `one_thread`, which holds in any process."""
    for name in VARIABLES:
        os.environ.setdefault(name, "1")  # an outside solver may be meant to have more


@cache
def _controller() -> Any:
    import_module("scipy.linalg.lapack")  # so that its BLAS is loaded and found too
    return import_module("threadpoolctl").ThreadpoolController()


def find_libraries() -> None:
    """Look for the BLAS of this process now, so that its forks need not."""
    _controller()


def limit_process() -> None:
    """One BLAS thread for the rest of this process, such as a worker."""
    set_thread_variables()
    _controller().limit(limits=1)


@contextmanager
def one_thread() -> Iterator[None]:
    """Inside, or in a function decorated by it, linear algebra of this process is in the calling thread."""
    with _controller().limit(limits=1):
        yield
