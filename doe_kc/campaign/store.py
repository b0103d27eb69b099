"""All true-solver evaluations of a study in one SQLite file: one writer, any number of readers."""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from functools import lru_cache
from pathlib import Path
from typing import Any

from doe_kc.campaign import store_file
from doe_kc.campaign.curves_codec import DamagedCurves
from doe_kc.campaign.record import Packed, StoredEvaluation, is_to_reduce_again, outcome_of
from doe_kc.campaign.store_file import REMOVE, in_words, lock
from doe_kc.ground.errors import InputError
from doe_kc.ground.output import make_folder
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.protocol import TrueSolver

EVALUATION_COLUMNS = "key, parameters, reason, characteristics, windows, seconds, origin, created, versions"
OUTCOME_COLUMNS = "key, '{}', reason, characteristics, windows, seconds, origin, created, '{}'"
"""The same without what outcomes do not hold."""
VALUE_MARKS = ", ".join("?" * 11)
"""For the values of a row."""


class Store:
    """Evaluations by key. Made by `open_store` or `read_store`; a context manager; for one thread.

    path: None for a store in memory. Every `put` is on the disk when it returns.
    """

    def __init__(
        self, connection: sqlite3.Connection, path: Path | None, meta: Mapping[str, str], held: ExitStack
    ) -> None:
        """held: what to give up with the store, the connection among it."""
        self.path = path
        self.meta = dict(meta)
        self._connection = connection
        self._where = _named(path)
        self._held = held

    def put(self, record: StoredEvaluation) -> None:
        """Store a record, in place of one with its key; RunError when the disk is full or not writable."""
        self.put_all([record])

    def put_all(self, records: Sequence[StoredEvaluation]) -> None:
        """Store records as `put`, in one transaction: all of them, or none."""
        rows = [_row(record) for record in records]
        with in_words(self._where):
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                self._connection.executemany(
                    f"INSERT OR REPLACE INTO evaluations VALUES ({VALUE_MARKS})", rows
                )
                self._connection.execute("COMMIT")
            except BaseException:
                if self._connection.in_transaction:
                    self._connection.execute("ROLLBACK")
                raise

    def status(self, key: str) -> str | None:
        """ok, failed, or None for a design that has not been evaluated."""
        with in_words(self._where):
            row = self._connection.execute("SELECT status FROM evaluations WHERE key = ?", (key,)).fetchone()
        return None if row is None else str(row[0])

    def lacks_curves(self, key: str, windows: Mapping[str, float], *, curves: bool) -> bool:
        """Whether a design was stored without the curves that it had, and they are asked for: by `curves`, or
        by windows other than those that it was reduced with."""
        with in_words(self._where):
            row = self._connection.execute(
                "SELECT windows FROM evaluations WHERE key = ? AND length(curves) = 0", (key,)
            ).fetchone()
        return row is not None and (curves or json.loads(row[0]) != dict(windows))

    def outcome(self, key: str, windows: Mapping[str, float], *, curves: bool = True) -> Outcome:
        """What was stored, its characteristics reduced with `windows`; KeyError for a design not there.

        curves: False leaves them out of the outcome, which saves memory and time.
        """
        record = self._record(key, "curves" if curves else "NULL")
        if not curves and not record.packed.reason and is_to_reduce_again(record, windows):
            record = self._record(key, "curves")
        return self.read(record, windows, curves=curves)

    def _record(self, key: str, curves: str) -> StoredEvaluation:
        """Without its parameters and versions. curves: what to read of them, an expression of SQL."""
        with in_words(self._where):
            row = self._connection.execute(
                f"SELECT {OUTCOME_COLUMNS}, {curves} FROM evaluations WHERE key = ?", (key,)
            ).fetchone()
        if row is None:
            raise KeyError(key)
        return _record(row)

    def read(self, record: StoredEvaluation, windows: Mapping[str, float], *, curves: bool = True) -> Outcome:
        """The outcome of a record of this store; InputError when its curves are damaged, or were left out and
        other windows ask for them."""
        if record.curves_left_out and dict(record.windows) != dict(windows):
            raise InputError(
                f"{self._where}: evaluation {record.key[:12]} was stored without curves, so that its "
                "characteristics cannot be fitted over other windows; sample again with --curves all."
            )
        try:
            return outcome_of(record, windows, curves=curves)
        except DamagedCurves:
            raise InputError(
                f"{self._where}: the curves of evaluation {record.key[:12]} are damaged; {REMOVE}."
            ) from None

    def records(self, origin: str = "*") -> Iterator[StoredEvaluation]:
        """All records in the order of their making, of the origins that match a glob such as `sample:*`."""
        query = f"SELECT {EVALUATION_COLUMNS}, curves FROM evaluations WHERE origin GLOB ? ORDER BY rowid"
        with in_words(self._where):
            for row in self._connection.execute(query, (origin,)):
                yield _record(row)

    def counts(self) -> dict[str, int]:
        """Number of evaluations by status."""
        with in_words(self._where):
            rows = self._connection.execute("SELECT status, count(*) FROM evaluations GROUP BY status")
            return {str(status): int(number) for status, number in rows}

    def __len__(self) -> int:
        return sum(self.counts().values())

    def close(self) -> None:
        """Give up the file and the lock on it."""
        with in_words(self._where):
            self._held.close()

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()


def _row(record: StoredEvaluation) -> tuple[object, ...]:
    """In the order of the table's columns."""
    packed = record.packed
    return (
        record.key,
        json.dumps(dict(record.parameters)),
        record.status,
        packed.reason,
        json.dumps(dict(packed.characteristics), allow_nan=False),
        _mapping_text(tuple(record.windows.items())),
        packed.curves,
        packed.seconds,
        record.origin,
        record.created,
        _mapping_text(tuple(record.versions.items())),
    )


@lru_cache(maxsize=64)
def _mapping_text(items: tuple[tuple[str, object], ...]) -> str:
    """JSON of a mapping that many records have in common."""
    return json.dumps(dict(items))


def _record(row: tuple[Any, ...]) -> StoredEvaluation:
    key, parameters, reason, characteristics, windows, seconds, origin, created, versions, curves = row
    return StoredEvaluation(
        key=key,
        parameters=json.loads(parameters),
        packed=Packed(reason, json.loads(characteristics), curves, seconds),
        windows=json.loads(windows),
        origin=origin,
        created=created,
        versions=json.loads(versions),
    )


def open_store(path: Path | None, solver: TrueSolver) -> Store:
    """The store of a solver's evaluations, made if need be, for this process alone to write.

    path: None keeps it in memory. InputError for a file that is damaged, of another program or newer
    version, or of another model or solver (and says what differs); RunError when another run writes to
    it, or file or folder are not writable.
    """
    where = _named(path)
    with ExitStack() as undo, in_words(where):
        if path is not None:
            make_folder(path.parent)
            undo.enter_context(closing(lock(path)))
        connection = undo.enter_context(closing(_connected(str(path or ":memory:"))))
        description = solver.describe()
        if store_file.is_empty(connection):
            store_file.create(connection, solver.fingerprint(), description)
        meta = store_file.read_meta(connection, where)
        store_file.check_solver(meta, solver.fingerprint(), description, where)
        if path is not None:  # only now that the file is known to be ours: it changes its header
            connection.execute("PRAGMA journal_mode = WAL")
            connection.execute("PRAGMA synchronous = NORMAL")
        return Store(connection, path, meta, undo.pop_all())


def read_store(path: Path) -> Store:
    """An existing store of any solver, to read; also while another process writes to it."""
    if not path.is_file():
        raise InputError(f"{path}: there is no such store; run doe-kc sample first, or check the path.")
    with ExitStack() as undo, in_words(str(path)):
        connection = undo.enter_context(closing(_connected(_to_read(path))))
        connection.execute("PRAGMA query_only = ON")
        meta = store_file.read_meta(connection, str(path))
        return Store(connection, path, meta, undo.pop_all())


def _to_read(path: Path) -> str:
    """A reader takes part in the write-ahead log, which needs two files beside the store; none on a medium
    that cannot be written, where nobody writes either."""
    writable = os.access(path, os.W_OK) and os.access(path.resolve().parent, os.W_OK)
    return f"{path.resolve().as_uri()}?mode={'rw' if writable else 'ro&immutable=1'}"


def _connected(place: str) -> sqlite3.Connection:
    return sqlite3.connect(place, timeout=30.0, isolation_level=None, uri=place.startswith("file:"))


def _named(path: Path | None) -> str:
    return str(path) if path is not None else "store in memory"
