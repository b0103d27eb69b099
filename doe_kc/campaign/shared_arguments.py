"""Arguments of a task, their arrays by way of memory that both processes open, not of the pipe between them.

Through the pipe of a process pool 24 MB take 95 ms, one task after the other; so they take 30.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")
SHARED_FROM = 1 << 20
"""Bytes of arrays from which sharing pays."""
SMALL_ARRAY = 1 << 12
"""Bytes below which an array goes through the pipe like all else."""
OPEN_FILES = "/proc/{}/fd"
"""Folder of a process's open files, by its number."""
PROTOCOL = 5
"""With which arrays may go another way than all else (Python Enhancement Proposal 574)."""


@dataclass(frozen=True)
class SharedArguments:
    """What is sent in place of the arguments. rest: all but the arrays, as multiprocessing sends it; path: of
    the memory, while `memory` is open; sizes: bytes of each array, one after the other there."""

    memory: int
    rest: bytes
    path: str
    sizes: tuple[int, ...]

    def close(self) -> None:
        """Let the memory go, once the task is done."""
        os.close(self.memory)


def shared_arguments(args: tuple[Any, ...], kwargs: Mapping[str, Any]) -> SharedArguments | None:
    """The arguments, to be closed; None where they have no large arrays, cannot be sent, or where processes
    share no memory by a path: elsewhere than on Linux with /proc."""
    own = Path(OPEN_FILES.format(os.getpid()))
    if sys.platform != "linux" or not own.is_dir():
        return None
    arrays: list[memoryview] = []

    def sent_along(buffer: Any) -> bool:
        raw: memoryview = buffer.raw()
        small = raw.nbytes < SMALL_ARRAY
        if not small:
            arrays.append(raw)
        return small

    rest = io.BytesIO()
    try:
        ForkingPickler(rest, PROTOCOL, True, sent_along).dump((args, dict(kwargs)))
    except Exception:  # the pool says why, as for any other task
        return None
    if sum(array.nbytes for array in arrays) < SHARED_FROM:
        return None
    with suppress(OSError):
        return _written(rest.getvalue(), arrays, own)
    return None


def called_with(fn: Callable[..., T], arguments: SharedArguments) -> T:
    """The task in the process that it was sent to, with arrays of its own."""
    arrays = [np.empty(size, dtype=np.uint8) for size in arguments.sizes]
    with Path(arguments.path).open("rb") as file:
        for array in arrays:
            file.readinto(array.data)
    args, kwargs = ForkingPickler.loads(arguments.rest, buffers=arrays)
    return fn(*args, **kwargs)


def _written(rest: bytes, arrays: list[memoryview], own: Path) -> SharedArguments:
    """own: folder of this process's open files. OSError where there is no memory for them."""
    memory = os.memfd_create("arguments")
    try:
        with open(memory, "wb", closefd=False) as file:
            for array in arrays:
                file.write(array)
    except OSError:
        os.close(memory)
        raise
    return SharedArguments(memory, rest, str(own / str(memory)), tuple(a.nbytes for a in arrays))
