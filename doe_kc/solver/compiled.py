"""Compiled kernels: generated C plus driver.c, built once per topology and kept in the user's cache."""

from __future__ import annotations

import ctypes
import hashlib
import inspect
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.elements import ELEMENTS
from doe_kc.solver.equilibria import Halt, March, Start, substeps
from doe_kc.solver.kernel import Kernel, kernel
from doe_kc.solver.newton import NewtonSettings

CACHE_VARIABLE = "DOE_KC_CACHE"
COMPILE_VARIABLE = "DOE_KC_COMPILE"
"""Set to 0 to stay interpreted."""
COMPILER_FLAGS = {"driver": "-O3", "jacobian": "-O0"}
"""By part; the rest -O1. The Jacobian is long and rarely called: at -O1 it takes 8 s to compile instead of
2 s, and a design of 370 equilibria would gain 2 ms."""
DEFAULT_FLAGS = "-O1"
COMPILE_TIMEOUT = 120.0
SUBSTEPS = 4
"""Equilibria a step, inside it and at its end, that a march with friction has room for at first."""
DRIVER = Path(__file__).with_name("driver.c")
MARCHED = ("residual", "jacobian", "outputs", "state_update")
"""Functions of a kernel that its library holds, beside the driver."""
PACKAGE = Path(__file__).parents[1]
ORIGINS = ("solver/**/*.py", "solver/*.c", "axle/*.py", "curves.py")
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


@dataclass(frozen=True)
class CompiledKernel:
    """A loaded library. path: where it lies."""

    path: Path
    library: ctypes.CDLL
    size_iw: int
    size_w: int

    def march(
        self,
        kernel: Kernel,
        c: FloatArray,
        start: Start,
        s: FloatArray,
        u: FloatArray,
        active: int,
        settings: NewtonSettings,
    ) -> March:
        """See `march.march`."""
        capacity = SUBSTEPS * len(s) if kernel.nz else 0
        path, passed = self._march(kernel, c, start, s, u, active, settings, capacity)
        if passed > capacity:
            path, _ = self._march(kernel, c, start, s, u, active, settings, passed)
        return path

    def _march(
        self,
        kernel: Kernel,
        c: FloatArray,
        start: Start,
        s: FloatArray,
        u: FloatArray,
        active: int,
        settings: NewtonSettings,
        capacity: int,
    ) -> tuple[March, int]:
        """The path, with `capacity` of its substeps, and how many there were."""

        n = len(s)
        x, z = np.zeros((n, kernel.nx)), np.zeros((n, kernel.nz))
        y, level = np.zeros((n, kernel.ny)), np.zeros(n)
        end = np.zeros(2 + kernel.nu + kernel.nz + kernel.nx)
        rows, passed = np.zeros((capacity, end.size)), np.zeros(1, dtype=np.int32)
        iterations, counts = np.zeros(n, dtype=np.int32), np.zeros(4, dtype=np.int64)
        tail, slips = kernel.tail_controls, kernel.slips
        inputs = [np.ascontiguousarray(a, dtype=float) for a in (start.s, start.x, start.u, start.z, s, u, c)]
        s_known, x_known, u_start, z_start, s_in, u_in, c_in = inputs
        code = self.library.march(
            *(ctypes.c_int(v) for v in (kernel.nx, active, kernel.nu, kernel.nz, kernel.ny)),
            ctypes.c_int(len(kernel.rows)),
            *(_pointer(a) for a in (kernel.rows, kernel.cols, tail, kernel.scale, c_in)),
            ctypes.c_double(settings.tol),
            ctypes.c_double(settings.refresh),
            ctypes.c_int(settings.max_iterations),
            ctypes.c_int(settings.max_halvings),
            ctypes.c_longlong(self.size_iw),
            ctypes.c_longlong(self.size_w),
            ctypes.c_int(start.guess),
            ctypes.c_int(len(slips)),
            _pointer(slips),
            ctypes.c_int(len(s_known)),
            *(_pointer(a) for a in (s_known, x_known, u_start, z_start)),
            ctypes.c_int(n),
            *(_pointer(a) for a in (s_in, u_in, x, z, y, iterations, level, end, counts)),
            ctypes.c_int(capacity),
            *(_pointer(a) for a in (rows, passed)),
        )
        if code < 0:
            raise MemoryError("the solver could not allocate its working memory")
        between = substeps(kernel, rows[: passed[0]]) if passed[0] else None
        if not code:
            return March(x, z, y, iterations, level, None, counts, None, between), int(passed[0])
        (s_end, snap), rest = end[:2], end[2:]
        u_end, z_end, x_end = np.split(rest, [kernel.nu, kernel.nu + kernel.nz])
        halt = Halt(float(s_end), x_end, u_end, z_end, float(snap))
        return March(x, z, y, iterations, level, code - 1, counts, halt, between), int(passed[0])


def _pointer(array: np.ndarray[Any, Any]) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


@lru_cache(maxsize=TOPOLOGY_CACHE)
def compiled_kernel(topology: Topology) -> CompiledKernel:
    """Build or load the library of a topology; CompileError when that cannot be done."""

    def sources() -> dict[str, str]:
        generated = {name: generate(kernel(topology).functions[name]) for name in MARCHED}
        return generated | {"driver": DRIVER.read_text()}

    path = library_of(topology, "kernel", sources, COMPILER_FLAGS)
    functions = [ca.external(name, str(path)) for name in MARCHED]
    return CompiledKernel(
        path,
        ctypes.CDLL(str(path)),
        max(f.sz_iw() for f in functions),
        max(f.sz_w() for f in functions),
    )


def library_of(
    topology: Topology, kind: str, sources: Callable[[], dict[str, str]], flags: Mapping[str, str]
) -> Path:
    """Shared library of one kind of a topology's functions; sources: C by part name, asked for if need be.

    Generating them takes longer than loading: an entry of the cache says which library follows from the
    topology and the package's own sources. CompileError as `build`.
    """
    origin = (kind, repr(topology), ca.CasadiMeta.version(), _origins())
    entry = cache_folder() / f"{_digest(_compiler(), flags, *origin)}.txt"
    with suppress(OSError, ValueError):
        path = entry.with_name(entry.read_text(encoding="utf-8"))
        if path.stem.endswith(f"-{fingerprint(path)}"):
            return path
    path = build(sources(), flags)
    try:
        with tempfile.NamedTemporaryFile(
            "w", dir=entry.parent, suffix=".tmp", delete=False, encoding="utf-8"
        ) as file:
            file.write(path.name)
        Path(file.name).replace(entry)
    except OSError as error:
        raise _unusable(entry.parent, error) from error
    return path


@lru_cache(maxsize=1)
def _origins() -> str:
    """Digest of the sources that equations are assembled from, elements of other packages included."""
    files = {file for pattern in ORIGINS for file in PACKAGE.glob(pattern)}
    files |= {Path(inspect.getfile(type(unit))) for unit in ELEMENTS}
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


def build(sources: dict[str, str], flags: Mapping[str, str] = COMPILER_FLAGS) -> Path:
    """Shared library of C sources by part name; from the cache when it has it."""
    compiler = _compiler()
    name = _digest(compiler, flags, *sources.values())
    folder = cache_folder()
    try:
        if found := cached(folder, name):
            return found
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as scratch:
            library = _compile(compiler, Path(scratch), sources, flags)
            target = folder / f"{name}-{fingerprint(library)}.so"
            library.replace(target)
    except OSError as error:
        raise _unusable(folder, error) from error
    return target


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


def generate(function: ca.Function) -> str:
    """C source of a CasADi function."""
    generator = ca.CodeGenerator(f"{function.name()}_part.c", {"with_header": False})
    generator.add(function)
    return str(generator.dump())


def _compile(compiler: str, scratch: Path, sources: dict[str, str], flags: Mapping[str, str]) -> Path:
    """All parts side by side, then one link."""
    running = []
    for part, text in sources.items():
        file = scratch / f"{part}.c"
        file.write_text(text)
        command = [compiler, flags.get(part, DEFAULT_FLAGS), "-fPIC", "-c", str(file)]
        running.append(_start([*command, "-o", str(file.with_suffix(".o"))]))
    messages = [_finish(process) for process in running]
    library = scratch / "library"
    if not any(messages):
        objects = [str(scratch / f"{part}.o") for part in sources]
        messages.append(_finish(_start([compiler, "-shared", "-o", str(library), *objects, "-lm"])))
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
