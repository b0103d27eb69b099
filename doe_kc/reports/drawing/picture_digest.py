"""Whether a picture on the disk already shows what would be drawn: by a digest of it in the file's head."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Callable, Mapping
from functools import cache, partial
from pathlib import Path
from types import BuiltinFunctionType, FunctionType, MethodType

import matplotlib
import numpy as np

from doe_kc import __version__

RUN_TIMES = frozenset({"seconds"})
"""Fields that differ between equal results; no picture shows them."""
FILE_HEAD, FILE_TAIL = 8192, 32
"""Bytes of a file in which the digest, and the mark of a whole file, are looked for."""
ENDS = {".png": b"IEND", ".svg": b"</svg>"}
SCALARS = (type(None), bool, int, float, complex, str, bytes, Path)
NUMBERS, CODE, SEQUENCES = (np.generic, np.ndarray), (FunctionType, BuiltinFunctionType, type), (list, tuple)


class PictureDigests:
    """Digests of makers of figures; values that several makers share are walked through once."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[object, bytes]] = {}
        self._open: set[int] = set()

    def of(self, make: Callable[[], object]) -> str | None:
        """SHA-256 of what a maker draws, and of the code that draws; None when it holds what has no digest,
        such as a compiled function."""
        try:
            content = self._of(make)
        except (TypeError, RecursionError):
            return None
        return hashlib.sha256(_drawing_code() + content).hexdigest()

    def _of(self, value: object) -> bytes:
        """Bytes that differ for another value: of a scalar its text, of everything else a digest."""
        if isinstance(value, SCALARS):
            return f"{type(value).__name__} {value!r}".encode()
        if isinstance(value, NUMBERS) and value.dtype.kind != "O":
            array = np.ascontiguousarray(value)
            return _sha("array", array.dtype.str, repr(array.shape), array.tobytes())
        if isinstance(value, CODE):
            if getattr(value, "__closure__", None):
                raise TypeError("a closure has no digest")
            return _sha("code", value.__module__ or "", value.__qualname__)
        known = self._known.get(id(value))
        if known is not None:
            return known[1]
        if id(value) in self._open:
            raise TypeError("a value that contains itself has no digest")
        self._open.add(id(value))
        try:
            digest = _sha(type(value).__qualname__, *self._parts(value))
        finally:
            self._open.discard(id(value))
        self._known[id(value)] = value, digest  # the value too, or another could come to have its id
        return digest

    def _parts(self, value: object) -> list[bytes]:
        if isinstance(value, partial):
            return [self._of(v) for v in (value.func, value.args, value.keywords)]
        if isinstance(value, MethodType):
            return [self._of(value.__func__), self._of(value.__self__)]
        if isinstance(value, SEQUENCES):
            return [self._of(part) for part in value]
        if isinstance(value, Mapping):
            return [self._of(part) for item in value.items() for part in item]
        if isinstance(value, set | frozenset):
            return sorted(self._of(part) for part in value)
        if dataclasses.is_dataclass(value):
            names = _field_names(value.__class__)
            return [part for name in names for part in (name.encode(), self._of(getattr(value, name)))]
        if not hasattr(value, "__dict__"):
            raise TypeError(f"{type(value).__name__} has no digest")
        return [self._of(item) for item in sorted(vars(value).items()) if item[0] not in RUN_TIMES]


def shows(path: Path, digest: str) -> bool:
    """Whether `path` is a whole picture with this digest in its head."""
    try:
        with path.open("rb") as file:
            head = file.read(FILE_HEAD)
            file.seek(-FILE_TAIL, 2)
            tail = file.read()
    except OSError:
        return False
    return digest.encode() in head and ENDS[path.suffix] in tail


@cache
def _field_names(kind: type) -> list[str]:
    return [f.name for f in dataclasses.fields(kind) if f.name not in RUN_TIMES]


def _sha(*parts: str | bytes) -> bytes:
    data = [part.encode() if isinstance(part, str) else part for part in parts]
    return hashlib.sha256(
        b"".join(piece for d in data for piece in (len(d).to_bytes(8, "little"), d))
    ).digest()


@cache
def _drawing_code() -> bytes:
    """Of the versions and of the reports' sources: another look is another picture."""
    sources = [p.read_bytes() for p in sorted(Path(__file__).parents[1].rglob("*.py"))]
    return _sha(__version__, matplotlib.__version__, *sources)
