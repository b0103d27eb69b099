"""Tables of the store, and whether a file is a store of the same model and solver."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from datetime import UTC, datetime

from doe_kc.campaign.sql_errors import REMOVE
from doe_kc.ground.errors import InputError

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
    parts = [_change(n, stored.get(n, "none"), description.get(n, "none")) for n in names[:DIFFERENCES]]
    rest = f", and {len(names) - DIFFERENCES} more" if len(names) > DIFFERENCES else ""
    return "; ".join(parts) + rest if parts else "its fingerprint differs"


def _change(name: str, then: str, now: str) -> str:
    short = len(then) <= 40 and len(now) <= 40
    return f"{name} was {then}, is {now}" if short else f"{name} differs"
