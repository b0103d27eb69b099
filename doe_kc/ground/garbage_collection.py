"""Python's garbage collector, where nothing that is made becomes garbage."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def no_garbage_collection() -> Iterator[None]:
    """Inside, the collector of this process stands still, in all its threads.

    It begins anew with every few hundred objects that are kept, and looks at all of them again and again:
    a third of the time in which tens of thousands of tuples are made.
    """
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if before:
            gc.enable()
