"""When compiling pays: libraries made once the programs in their place have cost as much."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Generic, TypeVar

from doe_kc.axle.topology import Topology
from doe_kc.solver.library import CompileError, store_text, stored_library, stored_text

OPERATIONS_BEFORE_COMPILING = 16_000_000_000
"""Of programs: by then compiled code would have saved about the time that compiling takes, 3 to 9 s. One
discovery carries out no more than half as many for any of its sets, and the next car has other sets."""
STORED_STEP = OPERATIONS_BEFORE_COMPILING // 40
"""Operations between two entries in the cache: 0.1 to 0.2 s of work."""

Library = TypeVar("Library")


class LibraryOnDemand(Generic[Library]):
    """The compiled library of one kind of a topology's functions, or none while programs are cheaper.

    Counted are the operations of all processes that share the user's cache, in whole steps of STORED_STEP, so
    that many short ones come to compiled code as one long one does. make: builds and loads the library, or
    loads what is built; CompileError where that cannot be done, whereupon the count begins anew.
    """

    def __init__(
        self, topology: Topology, kind: str, flags: Mapping[str, str], make: Callable[[], Library]
    ) -> None:
        self._topology, self._count_kind, self._make = topology, f"operations before {kind}", make
        self._library = make() if stored_library(topology, kind, flags) is not None else None
        self._new, self._stored = 0, self._in_cache()

    @property
    def ready(self) -> bool:
        """Whether there is a compiled library."""
        return self._library is not None

    @property
    def share(self) -> float:
        """Operations of the programs over those after which compiling pays; 0 when that is done."""
        return 0.0 if self.ready else (self._stored + self._new) / OPERATIONS_BEFORE_COMPILING

    def library(self) -> Library | None:
        """The library, made now if its time has come."""
        if self.share >= 1.0:
            self.make()
        return self._library

    def make(self) -> None:
        """Make it now; where that fails, the programs go on."""
        self._new = self._stored = 0
        store_text(self._topology, self._count_kind, "0")
        with suppress(CompileError):
            self._library = self._make()

    def count(self, operations: int) -> None:
        """Add operations that programs have carried out."""
        self._new += operations
        if self._new >= STORED_STEP:
            self._stored, self._new = max(self._stored, self._in_cache()) + self._new, 0
            store_text(self._topology, self._count_kind, str(self._stored))

    def _in_cache(self) -> int:
        text = stored_text(self._topology, self._count_kind)
        return int(text) if text is not None and text.isdecimal() else 0
