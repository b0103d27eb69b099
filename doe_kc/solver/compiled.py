"""Compiled marches: driver.c with the generated C of a topology, or with its programs until that pays."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate
from pathlib import Path
from typing import Protocol

import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.c_source import c_sources
from doe_kc.solver.equilibria import Halt, March, MarchProblem, substeps
from doe_kc.solver.kernel import (
    COMPILER_FLAGS,
    KERNEL_LIBRARY,
    MARCHED,
    Kernel,
    interpreted_functions,
    kernel_operations,
    kernel_programs,
)
from doe_kc.solver.library import handwritten, library_of
from doe_kc.solver.library_on_demand import LibraryOnDemand
from doe_kc.solver.program_library import MARCH_SOURCES, ProgramSet, march_library

SUBSTEPS = 4
"""Equilibria a step, inside it and at its end, that a march with friction has room for at first."""
INT, DOUBLE, ADDRESS = ctypes.c_int, ctypes.c_double, ctypes.c_void_p
MARCH_ARGUMENTS = (
    *(INT,) * 6, *(ADDRESS,) * 6, DOUBLE, DOUBLE, *(INT,) * 5, ADDRESS,
    INT, *(ADDRESS,) * 4, INT, *(ADDRESS,) * 7, INT, ADDRESS, ADDRESS,
)  # fmt: skip
"""Of `march` in driver.c, in its order."""


class MarchLibrary(Protocol):
    """Marches the axles of one topology."""

    def march(self, kernel: Kernel, problem: MarchProblem) -> March:
        """See `march.march`."""
        ...


@dataclass(frozen=True)
class CompiledKernel:
    """A loaded library of one topology. path: where it lies."""

    path: Path
    library: ctypes.CDLL

    def march(self, kernel: Kernel, problem: MarchProblem) -> March:
        """See `march.march`."""
        return _march_by(self.library.march, kernel, problem)


class AdaptiveKernel:
    """The programs of a topology, until so much has been asked of them that compiling pays.

    Both give the same numbers, digit for digit.
    """

    def __init__(self, topology: Topology) -> None:
        programs = kernel_programs(topology)
        self._library = march_library()
        self._library.march.argtypes = MARCH_ARGUMENTS
        self._programs = ProgramSet([programs[name] for name in MARCHED])
        self._lengths = np.array([programs["residual"].length, programs["jacobian"].length])
        self._on_demand = LibraryOnDemand(
            topology, KERNEL_LIBRARY, COMPILER_FLAGS, lambda: compiled_kernel(topology)
        )

    @property
    def compiled(self) -> bool:
        """Whether it is the compiled kernel that marches."""
        return self._on_demand.ready

    @property
    def share_before_compiling(self) -> float:
        """See `LibraryOnDemand.share`."""
        return self._on_demand.share

    def compile(self) -> None:
        """Compile now; where that fails, the programs go on."""
        self._on_demand.make()

    def march(self, kernel: Kernel, problem: MarchProblem) -> March:
        """See `march.march`."""
        if (library := self._on_demand.library()) is not None:
            return library.march(kernel, problem)
        self._library.use_programs(self._programs.address)
        path = _march_by(self._library.march, kernel, problem)
        self._on_demand.count(int(path.counts[:2] @ self._lengths))
        return path


def _march_by(function: Callable[..., int], kernel: Kernel, problem: MarchProblem) -> March:
    """function: `march` of driver.c."""
    capacity = SUBSTEPS * len(problem.s) if kernel.nz else 0
    path, passed = _march_with(function, kernel, problem, capacity)
    if passed > capacity:
        path, _ = _march_with(function, kernel, problem, passed)
    return path


def _march_with(
    function: Callable[..., int], kernel: Kernel, problem: MarchProblem, capacity: int
) -> tuple[March, int]:
    """The path, with `capacity` of its substeps, and how many there were."""
    start, settings, n = problem.start, problem.settings, len(problem.s)
    length = 2 + kernel.nu + kernel.nz + kernel.nx
    (x, z, y, end), out = _zeros((n, kernel.nx), (n, kernel.nz), (n, kernel.ny), (length,))
    rows, passed = np.zeros((capacity, length)), np.zeros(1, dtype=np.int32)
    counts = np.zeros(4, dtype=np.int64)
    known, (s_known, x_known, u_start, z_start, s_in, u_in, c_in) = _joined(
        start.s, start.x, start.u, start.z, problem.s, problem.u, problem.c
    )
    rows_in, cols_in, order, tail, scale, slips = kernel.addresses
    code = function(
        *(kernel.nx, problem.active, kernel.nu, kernel.nz, kernel.ny, len(kernel.rows)),
        *(rows_in, cols_in, order, tail, scale, c_in),
        *(settings.tol, settings.refresh, settings.max_iterations, settings.max_halvings),
        *(start.guess, kernel.coordinates, len(kernel.slips), slips),
        *(len(start.s), s_known, x_known, u_start, z_start, n, s_in, u_in),
        *(*out, counts.ctypes.data, capacity, rows.ctypes.data, passed.ctypes.data),
    )
    del known  # not before the library has read it
    if code < 0:
        raise MemoryError("the solver could not allocate its working memory")
    count = int(passed[0])
    between = substeps(kernel, rows[:count]) if count else None
    if not code:
        return March(x, z, y, None, counts, between), count
    (s_end, snap), rest = end[:2], end[2:]
    u_end, z_end, x_end = np.split(rest, [kernel.nu, kernel.nu + kernel.nz])
    halt = Halt(float(s_end), x_end, u_end, z_end, float(snap))
    return March(x, z, y, code - 1, counts, between, halt), count


def _zeros(*shapes: tuple[int, ...]) -> tuple[list[FloatArray], list[int]]:
    """Arrays of zeros beside each other, and their addresses, which are slow to ask for one by one."""
    sizes = [math.prod(shape) for shape in shapes]
    room = np.zeros(sum(sizes))
    first, ends = room.ctypes.data, list(accumulate(sizes))
    arrays = [room[e - n : e].reshape(shape) for n, e, shape in zip(sizes, ends, shapes, strict=True)]
    return arrays, [first + room.itemsize * (e - n) for n, e in zip(sizes, ends, strict=True)]


def _joined(*arrays: FloatArray) -> tuple[FloatArray, list[int]]:
    """A copy of the arrays, one after the other, and where in memory each begins."""
    room = np.concatenate([array.ravel() for array in arrays], dtype=float)
    first, ends = room.ctypes.data, accumulate(array.size for array in arrays)
    return room, [first + room.itemsize * (e - a.size) for a, e in zip(arrays, ends, strict=True)]


@lru_cache(maxsize=TOPOLOGY_CACHE)
def compiled_kernel(topology: Topology) -> CompiledKernel:
    """Build or load the library of a topology; CompileError when that cannot be done."""

    def sources() -> dict[str, str]:
        functions, operations = interpreted_functions(topology), kernel_operations(topology)
        out = {"driver": handwritten(*MARCH_SOURCES)}
        for name in (*MARCHED, "constants"):
            out |= c_sources(functions[name], operations=operations[name])
        return out

    path = library_of(topology, KERNEL_LIBRARY, sources, COMPILER_FLAGS)
    library = ctypes.CDLL(str(path))
    library.march.argtypes = MARCH_ARGUMENTS
    return CompiledKernel(path, library)


@lru_cache(maxsize=TOPOLOGY_CACHE)
def adaptive_kernel(topology: Topology) -> AdaptiveKernel:
    """What marches a topology; CompileError when the library of programs cannot be built."""
    return AdaptiveKernel(topology)
