"""Arguments and result of a task, their arrays by way of memory that both processes open, not of the pipe
between them.

Through the pipe of a process pool 24 MB take 95 ms, one task after the other; so they take 30. A
`CommonArgument` has memory of its own, as long as it lives: with the next task only its place there is sent.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from errno import ENOENT
from functools import lru_cache
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any, TypeVar, cast
from uuid import UUID, uuid4

import numpy as np

from doe_kc.ground.fields_only import CommonArgument

T = TypeVar("T")
SHARED_FROM = 1 << 20
"""Bytes of arrays from which sharing pays."""
SMALL_ARRAY = 1 << 12
"""Bytes below which an array goes through the pipe like all else."""
OPEN_FILES = "/proc/{}/fd"
"""Folder of a process's open files, by its number."""
COMMON_KEPT = 4
"""Common arguments that a process keeps, those used last."""
COPY = "_copy"
"""Under which a common argument has its copy in memory, beside its fields."""
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


class SharedCopy:
    """A common argument in memory of its own, which goes with this."""

    def __init__(self, rest: bytes, arrays: Sequence[memoryview]) -> None:
        self._number = os.memfd_create("copy")
        self.name = uuid4()
        """Of no other object that any process had."""
        self.content = _written(rest, arrays, Memory.of(_path(self._number)))

    def __del__(self) -> None:
        with suppress(AttributeError, OSError):
            os.close(self._number)


@lru_cache(maxsize=COMMON_KEPT)
def _common(_name: UUID, content: SharedObject) -> Any:
    """A common argument in the process that it was sent to."""
    return content.loaded()


@dataclass(frozen=True)
class SharedArguments:
    """Arguments in the memory of the process that sends them, which is its open file `number`."""

    number: int
    content: SharedObject
    copies: tuple[SharedCopy, ...] = ()
    """Of common arguments, in whose places the content says where they lie."""

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
    if sys.platform != "linux" or not Path(OPEN_FILES.format(os.getpid())).is_dir():
        return None
    copies: list[SharedCopy] = []
    parts = _parts((args, dict(kwargs)), copies)
    if parts is None:
        return None
    try:
        number = os.memfd_create("arguments")
    except OSError:
        return None
    with suppress(OSError):
        return SharedArguments(number, _written(*parts, Memory.of(_path(number))), tuple(copies))
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


class _Pickler(ForkingPickler):
    """As multiprocessing has it, but for common arguments: in their places stands where their copies lie.

    copies: to which those are added; None where common arguments go like all others. stays: whether a buffer
    does.
    """

    def __init__(
        self, rest: io.BytesIO, stays: Callable[[Any], bool], copies: list[SharedCopy] | None
    ) -> None:
        super().__init__(rest, PROTOCOL, True, stays)
        self._copies = copies

    def reducer_override(self, sent: Any) -> Any:
        """See `pickle.Pickler.reducer_override`."""
        if self._copies is None or not isinstance(sent, CommonArgument) or (copy := _copy_of(sent)) is None:
            return NotImplemented
        self._copies.append(copy)
        return _common, (copy.name, copy.content)


def _copy_of(sent: CommonArgument) -> SharedCopy | None:
    """Its copy, made with the first task; None where its arrays are small or find no room."""
    beside = vars(sent)
    if COPY not in beside:
        beside[COPY] = None
        if (parts := _parts(sent)) is not None:
            with suppress(OSError):
                beside[COPY] = SharedCopy(*parts)
    return cast("SharedCopy | None", beside[COPY])


def _parts(sent: Any, copies: list[SharedCopy] | None = None) -> tuple[bytes, Sequence[memoryview]] | None:
    """An object without its large arrays, and those; None without any, or where it cannot be sent.

    copies: see `_Pickler`.
    """
    arrays: list[memoryview] = []

    def stays(buffer: Any) -> bool:
        raw: memoryview = buffer.raw()
        small = raw.nbytes < SMALL_ARRAY
        if not small:
            arrays.append(raw)
        return small

    rest = io.BytesIO()
    try:
        _Pickler(rest, stays, copies).dump(sent)
    except Exception:  # the pool says why, as for any other task
        return None
    large = copies or sum(array.nbytes for array in arrays) >= SHARED_FROM
    return (rest.getvalue(), arrays) if large else None


def _path(number: int) -> str:
    """Of an open file of this process, for others."""
    return str(Path(OPEN_FILES.format(os.getpid())) / str(number))


def _written(rest: bytes, arrays: Sequence[memoryview], memory: Memory) -> SharedObject:
    """Behind what the memory holds. OSError where it is gone or has no room."""
    with memory.opened() as file:
        start = file.seek(0, os.SEEK_END)
        for array in arrays:
            file.write(array)
    return SharedObject(rest, memory, start, tuple(array.nbytes for array in arrays))
