"""Results of a discovery already computed, by key, in one SQLite file: what a killed run does not lose."""

from __future__ import annotations

import hashlib
import json
import math
import sqlite3
import zlib
from collections.abc import Mapping
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np

from doe_kc import __version__
from doe_kc.campaign.executors import InProcess
from doe_kc.campaign.store_file import in_words
from doe_kc.discovery.model import EffectModel
from doe_kc.ground.output import make_folder
from doe_kc.ground.typing import FloatArray

Arrays = Mapping[str, FloatArray]
BYTES = 8
"""Size of a number in the store."""
DIGITS = 7
"""Of them those that are stored as they are: digits, and four bits of the exponent. The last one has its sign
and the rest."""
LENGTH = 8
"""Bytes that say how long a part of the store is."""
PAGE_SIZE = 1 << 16
"""Bytes of a page of a new store, the most that SQLite has: writing 7 MB takes 11 ms, on pages of 4 kB 27."""
LOG_PAGES = 64
"""Pages that are written beside the store before they go into it: 4 MB, as SQLite has it with its own pages.
With as many pages as those a write that moved 64 MB took up to 0.2 s, now 0.02."""
WRITES_BEGUN = 4
"""Results that wait to be written at most: of some 8 MB each."""
TABLE = "packed_results"
FORMAT = "9"
"""Format of what is stored: raise it with every change of what a result means, of how it is computed so far
that its numbers differ, or of what is packed. Results of another format are not taken up, and computed
anew."""


class ResultCache:
    """Arrays by key; a context manager, for one thread. Every `put` is on the disk soon after it returns, and
    when the cache is closed.

    path: None keeps them in memory. InputError when the file is damaged, RunError when it cannot be written,
    from a later call than the `put` that met it.

    Packing and writing 8 MB takes 30 ms: a thread of the cache's own does both, while the search goes on.
    """

    def __init__(self, path: Path | None) -> None:
        if path is not None:
            make_folder(path.parent)
        self._where = str(path) if path is not None else "memory"
        self._thread: Executor = InProcess() if path is None else ThreadPoolExecutor(1, "result cache")
        self._begun: dict[str, Future[None]] = {}
        with in_words(self._where):
            self._writer = sqlite3.connect(path or ":memory:", isolation_level=None, check_same_thread=False)
            self._writer.execute(f"PRAGMA page_size = {PAGE_SIZE}")
            self._writer.execute(f"PRAGMA wal_autocheckpoint = {LOG_PAGES}")
            self._writer.execute("PRAGMA journal_mode = WAL")  # of which one reads while another writes
            self._writer.execute(f"CREATE TABLE IF NOT EXISTS {TABLE} (key TEXT PRIMARY KEY, arrays BLOB)")
            self._reader = self._writer if path is None else sqlite3.connect(path, isolation_level=None)

    def get(self, key: str) -> dict[str, FloatArray] | None:
        """The arrays, None for a key that is not there."""
        if key in self._begun:
            self._begun.pop(key).result()
        with in_words(self._where):
            row = self._reader.execute(f"SELECT arrays FROM {TABLE} WHERE key = ?", (key,)).fetchone()
        if row is None:
            return None
        return unpacked(row[0])

    def put(self, key: str, arrays: Arrays) -> None:
        """Store arrays, in place of those with the key."""
        self._wait(WRITES_BEGUN - 1)
        self._begun[key] = self._thread.submit(self._write, key, arrays)

    def close(self) -> None:
        """Give up the file, all that was put into it written."""
        try:
            self._wait(0)
        finally:
            self._thread.shutdown()
            self._reader.close()
            self._writer.close()

    def _wait(self, most: int) -> None:
        """Until no more than so many are being written, the first ones first."""
        while len(self._begun) > most:
            self._begun.pop(next(iter(self._begun))).result()

    def _write(self, key: str, arrays: Arrays) -> None:
        with in_words(self._where):
            self._writer.execute(f"INSERT OR REPLACE INTO {TABLE} VALUES (?, ?)", (key, packed(arrays)))

    def __enter__(self) -> ResultCache:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def packed(arrays: Arrays) -> bytes:
    """Arrays without loss: shapes; which numbers are not zero and their leading bytes, deflated; the rest.

    Signs and exponents of a column are alike and half of a Jacobian may be zero, digits are not; floats of 32
    bits would move evidences. Runs of one byte are all that is worth looking for: any that repeat, in two
    bytes of each number, took 50 ms for 8 MB in place of 20, and saved 3 % of it.
    """
    head = json.dumps({name: np.shape(a) for name, a in arrays.items()}).encode()
    numbers = (np.asarray(a, dtype=np.float64).T.ravel() for a in arrays.values())
    bits = np.concatenate([*numbers, np.zeros(0)]).view(np.uint64)
    there = bits != 0
    bits = bits[there]
    planes = bits.view(np.uint8).reshape(-1, BYTES).T
    runs = zlib.compressobj(1, strategy=zlib.Z_RLE)
    deflated = runs.compress(np.packbits(there).tobytes() + planes[DIGITS:].tobytes()) + runs.flush()
    return b"".join([_sized(head), _sized(deflated), planes[:DIGITS].tobytes()])


def unpacked(data: bytes) -> dict[str, FloatArray]:
    """Arrays of `packed`."""
    head, data = _parted(data)
    deflated, digits = _parted(data)
    shapes = json.loads(head)
    leading = np.frombuffer(zlib.decompress(deflated), np.uint8)
    size = sum(math.prod(shape) for shape in shapes.values())
    marks = -(-size // BYTES)
    there = np.unpackbits(leading[:marks], count=size).astype(bool)
    planes = np.vstack(
        [
            np.frombuffer(digits, np.uint8).reshape(DIGITS, -1),
            leading[marks:].reshape(BYTES - DIGITS, -1),
        ]
    )
    numbers = np.zeros(size)
    numbers[there] = np.ascontiguousarray(planes.T).view(np.float64).ravel()
    out, at = {}, 0
    for name, shape in shapes.items():
        count = math.prod(shape)
        out[name] = np.array(numbers[at : at + count].reshape(shape[::-1]).T, order="C")
        at += count
    return out


def _sized(part: bytes) -> bytes:
    return len(part).to_bytes(LENGTH, "little") + part


def _parted(data: bytes) -> tuple[bytes, bytes]:
    """A part of `_sized` and what follows it."""
    end = LENGTH + int.from_bytes(data[:LENGTH], "little")
    return data[LENGTH:end], data[end:]


def fingerprint(model: EffectModel) -> str:
    """Digest of everything that the model's answers depend on: axle, parameters, records, version, FORMAT."""
    digest = hashlib.sha256(f"{__version__} {FORMAT}".encode())
    axle = model.axle
    for text in (sorted(axle.values.items()), axle.topology, axle.load_cases, model.space, model.left_out):
        digest.update(repr(text).encode())
    if model.own_scatter is not None:
        digest.update(repr(model.own_scatter).encode())
    if model.scatter != 1.0:
        digest.update(repr(model.scatter).encode())
    if model.nuisances is not None:
        digest.update(model.nuisances.digest)
        digest.update(model.weights.tobytes())
    for member in model.members:
        digest.update(repr(member).encode())
    digest.update(model.likelihood.digest)
    return digest.hexdigest()


def key_of(*parts: str | FloatArray) -> str:
    """One key of several parts."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part.encode() if isinstance(part, str) else np.ascontiguousarray(part).tobytes())
    return digest.hexdigest()
