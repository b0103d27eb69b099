"""Results of a discovery already computed, by key, in one SQLite file: what a killed run does not lose."""

from __future__ import annotations

import hashlib
import json
import math
import sqlite3
import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from doe_kc import __version__
from doe_kc.campaign.store_file import in_words
from doe_kc.discovery.model import EffectModel
from doe_kc.ground.output import make_folder
from doe_kc.ground.typing import FloatArray

Arrays = Mapping[str, FloatArray]
BYTES = 8
"""Size of a number in the store."""
TABLE = "packed_results"
FORMAT = "4"
"""Format of what is stored: raise it with every change of what a result means, of how it is computed so far
that its numbers differ, or of what is packed. Results of another format are not taken up, and computed
anew."""


class ResultCache:
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
            self._connection.execute(
                f"CREATE TABLE IF NOT EXISTS {TABLE} (key TEXT PRIMARY KEY, arrays BLOB)"
            )

    def get(self, key: str) -> dict[str, FloatArray] | None:
        """The arrays, None for a key that is not there."""
        with in_words(self._where):
            row = self._connection.execute(f"SELECT arrays FROM {TABLE} WHERE key = ?", (key,)).fetchone()
        if row is None:
            return None
        return unpacked(row[0])

    def put(self, key: str, arrays: Arrays) -> None:
        """Store arrays, in place of those with the key."""
        with in_words(self._where):
            self._connection.execute(f"INSERT OR REPLACE INTO {TABLE} VALUES (?, ?)", (key, packed(arrays)))

    def close(self) -> None:
        """Give up the file."""
        self._connection.close()

    def __enter__(self) -> ResultCache:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def packed(arrays: Arrays) -> bytes:
    """Arrays without loss: shapes, then the bytes of all numbers sorted by their place in a number, deflated.

    Signs and exponents of a column are alike and half of a Jacobian is zero, digits are not: this is a third
    of the plain arrays, where deflating those as they are saves half, and floats of 32 bits would move
    evidences. Level 1: higher ones take three times as long for 3 %.
    """
    head = json.dumps({name: np.shape(a) for name, a in arrays.items()}).encode()
    numbers = [np.asarray(a, dtype=np.float64).T.ravel() for a in arrays.values()]
    planes = np.concatenate([*numbers, np.zeros(0)]).view(np.uint8).reshape(-1, BYTES).T
    return len(head).to_bytes(4, "little") + head + zlib.compress(planes.tobytes(), 1)


def unpacked(data: bytes) -> dict[str, FloatArray]:
    """Arrays of `packed`."""
    start = 4 + int.from_bytes(data[:4], "little")
    planes = np.frombuffer(zlib.decompress(data[start:]), np.uint8).reshape(BYTES, -1)
    numbers = np.ascontiguousarray(planes.T).view(np.float64).ravel()
    out, at = {}, 0
    for name, shape in json.loads(data[4:start]).items():
        count = math.prod(shape)
        out[name] = np.array(numbers[at : at + count].reshape(shape[::-1]).T, order="C")
        at += count
    return out


def fingerprint(model: EffectModel) -> str:
    """Digest of everything that the model's answers depend on: axle, parameters, records, version, FORMAT."""
    digest = hashlib.sha256(f"{__version__} {FORMAT}".encode())
    axle = model.axle
    for text in (sorted(axle.values.items()), axle.topology, axle.load_cases, model.space, model.left_out):
        digest.update(repr(text).encode())
    if model.scatter != 1.0:
        digest.update(repr(model.scatter).encode())
    if model.nuisances is not None:
        digest.update(np.ascontiguousarray(model.nuisances.columns).tobytes())
        digest.update(model.weights.tobytes())
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
