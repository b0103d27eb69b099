"""Shared libraries from generated C, built once per topology and kept in the user's cache."""

from __future__ import annotations

import hashlib
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType

import casadi as ca

from doe_kc.axle.topology import Topology
from doe_kc.solver.cache_limit import note_use, remove_unused

if sys.platform != "win32":
    import fcntl

CACHE_VARIABLE = "DOE_KC_CACHE"
COMPILE_VARIABLE = "DOE_KC_COMPILE"
"""Set to 0 to stay interpreted."""
DEFAULT_FLAGS = "-O1 -ffp-contract=off"
"""Every operation rounds by itself, as in program.c: both give the same numbers on any processor."""
COMPILE_TIMEOUT = 600.0
"""s; of a machine that does much else."""
PACKAGE = Path(__file__).parents[1]
PROCESSOR_HEADER = Path(__file__).with_name("processor.h")
ORIGINS = ("solver/**/*.py", "solver/*.[ch]", "axle/*.py", "curves.py")
"""Sources of the package that generated code follows from."""


class CompileError(Exception):
    """There is no working C compiler, or the cache cannot be written; says which."""


def cache_folder() -> Path:
    """Where compiled kernels live: $DOE_KC_CACHE, else the platform's user cache."""
    if own := os.environ.get(CACHE_VARIABLE):
        return Path(own)
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "doe_kc"
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "doe_kc"


def find_compiler() -> str | None:
    """Path of $CC, cc, gcc or clang, whichever is found first."""
    for name in (os.environ.get("CC"), "cc", "gcc", "clang"):
        if name and (path := shutil.which(name)):
            return path
    return None


def library_of(
    topology: Topology, kind: str, sources: Callable[[], dict[str, str]], flags: Mapping[str, str]
) -> Path:
    """Shared library of one kind of a topology's functions; sources: C by part name, asked for if need be.

    Generating them takes longer than loading: an entry of the cache says which library follows from the
    topology and the package's own sources. Of several processes that ask for one at a time, one builds it.
    CompileError as `build`.
    """
    path = stored_library(topology, kind, flags)
    if path is not None:
        return path
    entry = _library_entry(topology, kind, flags)
    try:
        with _alone(entry.with_suffix(".lock")):
            path = stored_library(topology, kind, flags)
            if path is None:
                path = build(sources(), flags)
                _write_entry(entry, path.name.encode())
            return path
    except OSError as error:
        raise _unusable(entry.parent, error) from error


def stored_library(topology: Topology, kind: str, flags: Mapping[str, str]) -> Path | None:
    """What `library_of` would give if the cache has it; CompileError without a compiler."""
    entry = _library_entry(topology, kind, flags)
    with suppress(OSError, ValueError):
        path = entry.with_name(entry.read_text(encoding="utf-8"))
        if path.stem.endswith(f"-{fingerprint(path)}"):
            note_use(entry)
            note_use(path)
            return path
    return None


def stored_text(topology: Topology, kind: str) -> str | None:
    """What `store_text` put into the cache for a topology and the package's own sources."""
    with suppress(OSError, ValueError):
        entry = _entry(topology, kind, ".json")
        note_use(entry)
        return entry.read_text(encoding="utf-8")
    return None


def store_text(topology: Topology, kind: str, text: str) -> None:
    """Keep a text that follows from a topology; a cache that cannot be written is passed over."""
    _store(_entry(topology, kind, ".json"), text.encode())


def stored_bytes(topology: Topology, kind: str) -> bytes | None:
    """What `store_bytes` put into the cache for a topology and the package's own sources."""
    with suppress(OSError):
        entry = _entry(topology, kind, ".npz")
        note_use(entry)
        return entry.read_bytes()
    return None


def store_bytes(topology: Topology, kind: str, content: bytes) -> None:
    """Keep arrays that follow from a topology; a cache that cannot be written is passed over."""
    _store(_entry(topology, kind, ".npz"), content)


@contextmanager
def _alone(lock: Path) -> Iterator[None]:
    """Until no other process holds the lock, which the system takes from one that dies."""
    lock.parent.mkdir(parents=True, exist_ok=True)
    try:
        with lock.open("w") as file:
            if sys.platform != "win32":
                fcntl.flock(file, fcntl.LOCK_EX)
            yield
    finally:
        lock.unlink(missing_ok=True)


def _library_entry(topology: Topology, kind: str, flags: Mapping[str, str]) -> Path:
    return cache_folder() / f"{_digest(_compiler(), flags, *_origin(topology, kind))}.txt"


def _entry(topology: Topology, kind: str, suffix: str) -> Path:
    return cache_folder() / f"{_digest('', {}, *_origin(topology, kind))}{suffix}"


def _origin(topology: Topology, kind: str) -> tuple[str, ...]:
    return kind, repr(topology), ca.CasadiMeta.version(), _origins()


def _store(entry: Path, content: bytes) -> None:
    with suppress(OSError):
        entry.parent.mkdir(parents=True, exist_ok=True)
        _write_entry(entry, content)


def _write_entry(entry: Path, content: bytes) -> None:
    with tempfile.NamedTemporaryFile(dir=entry.parent, suffix=".tmp", delete=False) as file:
        file.write(content)
    Path(file.name).replace(entry)


@lru_cache(maxsize=1)
def _origins() -> str:
    """Digest of the sources that equations are assembled from."""
    files = {file for pattern in ORIGINS for file in PACKAGE.glob(pattern)}
    return hashlib.sha256(b"\0".join(file.read_bytes() for file in sorted(files))).hexdigest()


def _compiler() -> str:
    compiler = find_compiler()
    if compiler is None:
        raise CompileError("no C compiler (cc, gcc or clang) is on the path")
    return compiler


def _digest(compiler: str, flags: Mapping[str, str], *parts: str) -> str:
    identity = "\0".join([platform.machine(), compiler, repr(sorted(flags.items())), *parts])
    return hashlib.sha256(identity.encode()).hexdigest()[:24]


def _unusable(folder: Path, error: OSError) -> CompileError:
    return CompileError(f"the cache folder {folder} cannot be used ({error.strerror})")


def build(sources: dict[str, str], flags: Mapping[str, str] = MappingProxyType({})) -> Path:
    """Shared library of C sources by part name; from the cache when it has it."""
    compiler = _compiler()
    name = _digest(compiler, flags, *sources.values())
    folder = cache_folder()
    try:
        if library_path := cached(folder, name):
            return library_path
        with _alone(folder / f"{name}.lock"):
            if library_path := cached(folder, name):
                return library_path
            with tempfile.TemporaryDirectory(dir=folder) as scratch:
                library = _compile(compiler, Path(scratch), sources, flags)
                target = folder / f"{name}-{fingerprint(library)}.so"
                library.replace(target)
            remove_unused(folder)
            return target
    except OSError as error:
        raise _unusable(folder, error) from error


def cached(folder: Path, name: str) -> Path | None:
    """The library `name` in the cache; a damaged one, whose content is not what its name says, is removed.

    Loading a truncated library would kill the process.
    """
    for path in folder.glob(f"{name}-*.so"):
        if path.stem == f"{name}-{fingerprint(path)}":
            return path
        path.unlink(missing_ok=True)
    return None


def fingerprint(path: Path) -> str:
    """Start of the SHA-256 of a file's content."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def handwritten(*files: Path) -> str:
    """C source of files of the package, with what chooses a processor's vector instructions before it."""
    return "".join(file.read_text() for file in (PROCESSOR_HEADER, *files))


def _compile(compiler: str, scratch: Path, sources: dict[str, str], flags: Mapping[str, str]) -> Path:
    """All parts side by side, then one link. flags: by part, "" for the others, "link" for the link."""
    running = []
    for part, text in sources.items():
        file = scratch / f"{part}.c"
        file.write_text(text)
        own = flags.get(part, flags.get("", DEFAULT_FLAGS)).split()
        command = [compiler, *own, "-fPIC", "-c", str(file)]
        running.append(_start([*command, "-o", str(file.with_suffix(".o"))]))
    messages = [_finish(process) for process in running]
    library = scratch / "library"
    if not any(messages):
        objects = [str(scratch / f"{part}.o") for part in sources]
        link = flags.get("link", "-lm").split()
        messages.append(_finish(_start([compiler, "-shared", "-o", str(library), *objects, *link])))
    if failures := [m for m in messages if m]:
        raise CompileError(f"{compiler} failed: {failures[0][:200]}")
    return library


def _start(command: list[str]) -> subprocess.Popen[str]:
    try:
        return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        raise CompileError(f"{command[0]} cannot be run ({error.strerror})") from error


def _finish(process: subprocess.Popen[str]) -> str:
    """What went wrong, empty when nothing did."""
    try:
        _, message = process.communicate(timeout=COMPILE_TIMEOUT)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return f"it took more than {COMPILE_TIMEOUT:g} s"
    return message.strip() or f"exit code {process.returncode}" if process.returncode else ""
