"""Results of a discovery already computed, by key, in one SQLite file: what a killed run does not lose."""

from __future__ import annotations

import hashlib
import io
import sqlite3
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from doe_kc import __version__
from doe_kc.campaign.sql_errors import in_words
from doe_kc.discovery.model import EffectModel
from doe_kc.output import make_folder
from doe_kc.typing import FloatArray

Arrays = Mapping[str, FloatArray]


class Ledger:
    """Arrays by key; a context manager, for one thread. Every `put` is on the disk when it returns.

    path: None keeps them in memory. RunError when the file is damaged or cannot be written.
    """

    def __init__(self, path: Path | None) -> None:
        if path is not None:
            make_folder(path.parent)
        self._where = str(path) if path is not None else "memory"
        with in_words(self._where):
            self._connection = sqlite3.connect(path or ":memory:", isolation_level=None)
            self._connection.execute("PRAGMA journal_mode = WAL")
            self._connection.execute("CREATE TABLE IF NOT EXISTS results (key TEXT PRIMARY KEY, arrays BLOB)")

    def get(self, key: str) -> dict[str, FloatArray] | None:
        """The arrays, None for a key that is not there."""
        with in_words(self._where):
            row = self._connection.execute("SELECT arrays FROM results WHERE key = ?", (key,)).fetchone()
        if row is None:
            return None
        with np.load(io.BytesIO(row[0]), allow_pickle=False) as found:
            return {name: found[name] for name in found.files}

    def put(self, key: str, arrays: Arrays) -> None:
        """Store arrays, in place of those with the key."""
        buffer = io.BytesIO()
        np.savez(buffer, **dict(arrays))  # type: ignore[arg-type]  # its stub takes allow_pickle for a name
        with in_words(self._where):
            self._connection.execute("INSERT OR REPLACE INTO results VALUES (?, ?)", (key, buffer.getvalue()))

    def close(self) -> None:
        """Give up the file."""
        self._connection.close()

    def __enter__(self) -> Ledger:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def fingerprint(model: EffectModel) -> str:
    """Of everything that the model's answers depend on: axle, parameters, records, version."""
    digest = hashlib.sha256(__version__.encode())
    axle = model.axle
    for text in (sorted(axle.values.items()), axle.topology, axle.load_cases, model.space, model.left_out):
        digest.update(repr(text).encode())
    if model.sides is not None:
        digest.update(np.ascontiguousarray(model.sides).tobytes())
    for member in model.members:
        digest.update(repr(member).encode())
    for curve in model.likelihood.curves:
        digest.update(f"{curve.load_case} {curve.response} {curve.side} {curve.branches}".encode())
        for array in (curve.input, curve.value, curve.root):
            digest.update(np.ascontiguousarray(array).tobytes())
    digest.update(repr(model.likelihood.figures).encode())
    return digest.hexdigest()


def key_of(*parts: str | FloatArray) -> str:
    """One key of several parts."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part.encode() if isinstance(part, str) else np.ascontiguousarray(part).tobytes())
    return digest.hexdigest()
