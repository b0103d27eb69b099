"""One writer a store: a lock that ends with the process that holds it, however that ends."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from doe_kc.campaign.sql_errors import translated
from doe_kc.ground.errors import RunError


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
