"""How much the cache of compiled kernels may hold: what has not been used for longest goes first."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path

CACHE_LIMIT = 2_000_000_000
"""Bytes. A topology takes 1 to 5 MB, the search for the effects of one car some sixty topologies."""
KEPT_SHARE = 0.8
"""Of the limit, that is left where it was passed: not every new kernel has to look for an old one."""
SAME_USE = 86_400.0
"""s within which a file counts as used once: a use is a write to the disk."""
SUFFIXES = {".so", ".txt", ".json", ".npz"}


def note_use(path: Path) -> None:
    """Give a file of the cache the time of its use, at most once a day; a cache of others stays as it is."""
    with suppress(OSError):
        if time.time() - path.stat().st_mtime > SAME_USE:
            os.utime(path)


def remove_unused(folder: Path, limit: int = CACHE_LIMIT) -> None:
    """Where the files of the cache exceed `limit` bytes together, remove those unused for longest.

    A library that a process has loaded stays whole for it; one that it is about to load was used just now.
    """
    files: list[tuple[float, int, Path]] = []
    for path in folder.iterdir():
        with suppress(OSError):
            if path.suffix in SUFFIXES:
                status = path.stat()
                files.append((status.st_mtime, status.st_size, path))
    total = sum(size for _, size, _ in files)
    if total <= limit:
        return
    for _, size, path in sorted(files):
        with suppress(OSError):
            path.unlink()
            total -= size
        if total <= KEPT_SHARE * limit:
            return
