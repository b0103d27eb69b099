"""Database errors as one sentence that names the file and the remedy."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager

from doe_kc.ground.errors import DoeKcError, InputError, RunError

DAMAGED = ("SQLITE_NOTADB", "SQLITE_CORRUPT", "SQLITE_FORMAT")
REMOVE = "move it away and run again, or choose another folder with --out"


@contextmanager
def in_words(where: str) -> Iterator[None]:
    """InputError for a file that is no sound store, RunError for a disk that is full or not writable."""
    try:
        yield
    except sqlite3.DatabaseError as error:
        raise translated(error, where) from None


def translated(error: sqlite3.DatabaseError, where: str) -> DoeKcError:
    """The error to raise in place of SQLite's."""
    code = getattr(error, "sqlite_errorname", "") or ""
    if code.startswith(DAMAGED):
        return InputError(f"{where}: is not a store of evaluations, or is damaged ({error}); {REMOVE}.")
    if code.startswith("SQLITE_FULL"):
        return RunError(
            f"{where}: the disk is full; the evaluations stored before are kept. Free some space and give "
            "the same command again."
        )
    if code.startswith(("SQLITE_READONLY", "SQLITE_CANTOPEN", "SQLITE_PERM", "SQLITE_AUTH")):
        return RunError(
            f"{where}: cannot be written ({error}); make file and folder writable, or choose another folder "
            "with --out."
        )
    if code.startswith(("SQLITE_BUSY", "SQLITE_LOCKED")):
        return RunError(f"{where}: another program holds the file ({error}); wait for it or end it.")
    return RunError(
        f"{where}: cannot be read or written ({error}); the evaluations stored before are kept. Check the "
        "disk and give the same command again."
    )
