"""The store's file: its lock, its tables and whose they are, and its errors in words."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from doe_kc.ground.errors import DoeKcError, InputError, RunError
from doe_kc.ground.listing import first_of


def lock(path: Path) -> sqlite3.Connection:
    """Holds `path`.lock until the connection is closed; RunError when another run has it.

    SQLite's own lock on an empty file beside the store: worker processes do not inherit it, as they would
    an flock, and readers of the store are not in its way.
    """
    place = path.with_name(path.name + ".lock")
    try:
        connection = sqlite3.connect(place, timeout=0.0, isolation_level=None)
    except sqlite3.DatabaseError as error:
        raise translated(error, str(place)) from None
    try:
        connection.execute("BEGIN EXCLUSIVE")
    except sqlite3.DatabaseError as error:
        connection.close()
        if (error.sqlite_errorname or "").startswith("SQLITE_BUSY"):
            raise RunError(
                f"{path}: another run is writing to this store; wait until it has ended, or choose another "
                "folder with --out."
            ) from None
        raise translated(error, str(place)) from None
    return connection


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


SCHEMA = 1
STORE_SCHEMA = """
CREATE TABLE meta (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE evaluations (
    key TEXT PRIMARY KEY,
    parameters TEXT NOT NULL,
    status TEXT NOT NULL CHECK (status IN ('ok', 'failed')),
    reason TEXT NOT NULL,
    characteristics TEXT NOT NULL,
    windows TEXT NOT NULL,
    curves BLOB,
    seconds REAL NOT NULL,
    origin TEXT NOT NULL,
    created TEXT NOT NULL,
    versions TEXT NOT NULL
);
"""
DIFFERENCES = 3
"""Of another solver that one sentence lists."""


def create(connection: sqlite3.Connection, fingerprint: str, description: Mapping[str, str]) -> None:
    """Empty tables for one solver, all or nothing."""
    meta = {
        "schema": str(SCHEMA),
        "fingerprint": fingerprint,
        "description": json.dumps(dict(description)),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
    }
    connection.execute("BEGIN IMMEDIATE")
    for statement in STORE_SCHEMA.strip().split(";")[:-1]:
        connection.execute(statement)
    connection.executemany("INSERT INTO meta VALUES (?, ?)", meta.items())
    connection.execute("COMMIT")


def is_empty(connection: sqlite3.Connection) -> bool:
    """Whether the file is new."""
    return connection.execute("SELECT 1 FROM sqlite_master LIMIT 1").fetchone() is None


def read_meta(connection: sqlite3.Connection, where: str) -> dict[str, str]:
    """The meta table; InputError when the file is another program's, or of a newer doe_kc."""
    try:
        meta = dict(connection.execute("SELECT name, value FROM meta").fetchall())
        connection.execute("SELECT key, origin FROM evaluations LIMIT 1")
        schema = int(meta["schema"])
    except (sqlite3.OperationalError, KeyError, ValueError):
        raise InputError(f"{where}: is a database, but no store of evaluations; {REMOVE}.") from None
    if schema > SCHEMA:
        raise InputError(
            f"{where}: was written by a newer doe_kc (schema {schema}, this one reads up to {SCHEMA}); "
            "update doe_kc, or choose another folder with --out."
        )
    return meta


def check_solver(
    meta: Mapping[str, str], fingerprint: str, description: Mapping[str, str], where: str
) -> None:
    """InputError that says what differs when the store is of another model or solver."""
    if meta["fingerprint"] == fingerprint:
        return
    raise InputError(
        f"{where}: holds evaluations of another model or solver ({_difference(meta, description)}); give "
        "another folder with --out, or remove the file."
    )


def _difference(meta: Mapping[str, str], description: Mapping[str, str]) -> str:
    stored: dict[str, str] = json.loads(meta.get("description", "{}"))
    names = [n for n in {**description, **stored} if stored.get(n) != description.get(n)]
    parts = [_change(n, stored.get(n, "none"), description.get(n, "none")) for n in names]
    return first_of(parts, DIFFERENCES, separator="; ") or "its fingerprint differs"


def _change(name: str, then: str, now: str) -> str:
    short = len(then) <= 40 and len(now) <= 40
    return f"{name} was {then}, is {now}" if short else f"{name} differs"
