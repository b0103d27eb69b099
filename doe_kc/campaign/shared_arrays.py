"""Arguments and result of a task, their arrays by way of memory that both processes open, not of the pipe
between them.

Through the pipe of a process pool 24 MB take 95 ms, one task after the other; so they take 30.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from errno import ENOENT
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any, TypeVar, cast

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
class Memory:
    """A file in memory by its path, which may come to stand for another file, and its own numbers."""

    path: str
    device: int
    inode: int

    @classmethod
    def of(cls, path: str) -> Memory:
        """That which a path stands for now."""
        status = Path(path).stat()
        return cls(path, status.st_dev, status.st_ino)

    @contextmanager
    def opened(self) -> Iterator[io.BufferedRandom]:
        """To read and write. OSError where it is gone: beside a lost worker others come too late."""
        with Path(self.path).open("r+b") as file:
            status = os.fstat(file.fileno())
            if (status.st_dev, status.st_ino) != (self.device, self.inode):
                raise FileNotFoundError(ENOENT, "the memory of the task is gone", self.path)
            yield file


@dataclass(frozen=True)
class SharedObject:
    """What is sent in place of an object. rest: all but its large arrays, as multiprocessing sends it;
    memory: that those lie in, one after the other from `start` on; sizes: bytes of each."""

    rest: bytes
    memory: Memory
    start: int
    sizes: tuple[int, ...]

    def loaded(self) -> Any:
        """The object, with arrays of its own."""
        arrays = [np.empty(size, dtype=np.uint8) for size in self.sizes]
        with self.memory.opened() as file:
            file.seek(self.start)
            for array in arrays:
                file.readinto(array.data)
        return ForkingPickler.loads(self.rest, buffers=arrays)


@dataclass(frozen=True)
class SharedArguments:
    """Arguments in the memory of the process that sends them, which is its open file `number`."""

    number: int
    content: SharedObject

    def close(self) -> None:
        """Let the memory go, once the task is done and its result there."""
        os.close(self.number)


@dataclass(frozen=True)
class SharedResult:
    """A result in the memory of the task's arguments: where it is received it is the result itself."""

    content: SharedObject

    def __reduce__(self) -> tuple[Callable[[SharedObject], Any], tuple[SharedObject]]:
        return SharedObject.loaded, (self.content,)


def shared_arguments(args: tuple[Any, ...], kwargs: Mapping[str, Any]) -> SharedArguments | None:
    """The arguments, to be closed; None where they have no large arrays, cannot be sent, or where processes
    share no memory by a path: elsewhere than on Linux with /proc."""
    own = Path(OPEN_FILES.format(os.getpid()))
    if sys.platform != "linux" or not own.is_dir() or (parts := _parts((args, dict(kwargs)))) is None:
        return None
    try:
        number = os.memfd_create("arguments")
    except OSError:
        return None
    with suppress(OSError):
        return SharedArguments(number, _written(*parts, Memory.of(str(own / str(number)))))
    os.close(number)
    return None


def called_with(fn: Callable[..., T], arguments: SharedObject) -> T:
    """The task in the process that it was sent to. Where its result has large arrays, and there is room for
    them in the same memory, a `SharedResult` in its place."""
    args, kwargs = arguments.loaded()
    result = fn(*args, **kwargs)
    del args, kwargs
    if (parts := _parts(result)) is not None:
        with suppress(OSError):
            return cast(T, SharedResult(_written(*parts, arguments.memory)))
    return result


def _parts(sent: Any) -> tuple[bytes, Sequence[memoryview]] | None:
    """An object without its large arrays, and those; None without any, or where it cannot be sent."""
    arrays: list[memoryview] = []

    def stays(buffer: Any) -> bool:
        raw: memoryview = buffer.raw()
        small = raw.nbytes < SMALL_ARRAY
        if not small:
            arrays.append(raw)
        return small

    rest = io.BytesIO()
    try:
        ForkingPickler(rest, PROTOCOL, True, stays).dump(sent)
    except Exception:  # the pool says why, as for any other task
        return None
    return (rest.getvalue(), arrays) if sum(array.nbytes for array in arrays) >= SHARED_FROM else None


def _written(rest: bytes, arrays: Sequence[memoryview], memory: Memory) -> SharedObject:
    """Behind what the memory holds. OSError where it is gone or has no room."""
    with memory.opened() as file:
        start = file.seek(0, os.SEEK_END)
        for array in arrays:
            file.write(array)
    return SharedObject(rest, memory, start, tuple(array.nbytes for array in arrays))
