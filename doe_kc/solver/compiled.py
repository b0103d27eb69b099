"""Compiled kernels: generated C plus driver.c, loaded from a shared library."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import accumulate
from pathlib import Path

import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.c_source import c_sources
from doe_kc.solver.equilibria import Halt, March, Start, substeps
from doe_kc.solver.kernel import COMPILER_FLAGS, KERNEL_LIBRARY, MARCHED, Kernel, interpreted_functions
from doe_kc.solver.library import handwritten, library_of
from doe_kc.solver.newton import NewtonSettings

SUBSTEPS = 4
"""Equilibria a step, inside it and at its end, that a march with friction has room for at first."""
DRIVER = Path(__file__).with_name("driver.c")
MARCH_HEADER = Path(__file__).with_name("march.h")
"""The constants of march.py and newton.py, for the compiled marches."""
INT, DOUBLE, ADDRESS = ctypes.c_int, ctypes.c_double, ctypes.c_void_p
MARCH_ARGUMENTS = (
    *(INT,) * 6, *(ADDRESS,) * 5, DOUBLE, DOUBLE, *(INT,) * 5, ADDRESS,
    INT, *(ADDRESS,) * 4, INT, *(ADDRESS,) * 9, INT, ADDRESS, ADDRESS,
)  # fmt: skip
"""Of `march` in driver.c, in its order."""


@dataclass(frozen=True)
class CompiledKernel:
    """A loaded library. path: where it lies."""

    path: Path
    library: ctypes.CDLL

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
        n, length = len(s), 2 + kernel.nu + kernel.nz + kernel.nx
        (x, z, y, level, end), out = _zeros((n, kernel.nx), (n, kernel.nz), (n, kernel.ny), (n,), (length,))
        rows, whole = np.zeros((capacity, length)), np.zeros(n + 1, dtype=np.int32)
        counts = np.zeros(4, dtype=np.int64)
        known, (s_known, x_known, u_start, z_start, s_in, u_in, c_in) = _joined(
            start.s, start.x, start.u, start.z, s, u, c
        )
        jacobian_rows, jacobian_cols, tail, scale, slips = kernel.addresses
        iterations_out = whole.ctypes.data
        code = self.library.march(
            *(kernel.nx, active, kernel.nu, kernel.nz, kernel.ny, len(kernel.rows)),
            *(jacobian_rows, jacobian_cols, tail, scale, c_in),
            *(settings.tol, settings.refresh, settings.max_iterations, settings.max_halvings),
            *(start.guess, kernel.coordinates, len(kernel.slips), slips),
            *(len(start.s), s_known, x_known, u_start, z_start, n, s_in, u_in),
            *(*out[:3], iterations_out, *out[3:], counts.ctypes.data),
            *(capacity, rows.ctypes.data, iterations_out + n * whole.itemsize),
        )
        del known  # not before the library has read it
        iterations, passed = whole[:n], int(whole[n])
        if code < 0:
            raise MemoryError("the solver could not allocate its working memory")
        between = substeps(kernel, rows[:passed]) if passed else None
        if not code:
            return March(x, z, y, iterations, level, None, counts, None, between), passed
        (s_end, snap), rest = end[:2], end[2:]
        u_end, z_end, x_end = np.split(rest, [kernel.nu, kernel.nu + kernel.nz])
        halt = Halt(float(s_end), x_end, u_end, z_end, float(snap))
        return March(x, z, y, iterations, level, code - 1, counts, halt, between), passed


def _zeros(*shapes: tuple[int, ...]) -> tuple[list[FloatArray], list[int]]:
    """Arrays of zeros beside each other, and their addresses, which are slow to ask for one by one."""
    sizes = [math.prod(shape) for shape in shapes]
    room = np.zeros(sum(sizes))
    first, ends = room.ctypes.data, list(accumulate(sizes))
    arrays = [room[e - n : e].reshape(shape) for n, e, shape in zip(sizes, ends, shapes, strict=True)]
    return arrays, [first + room.itemsize * (e - n) for n, e in zip(sizes, ends, strict=True)]


def _joined(*arrays: FloatArray) -> tuple[FloatArray, list[int]]:
    """A copy of the arrays, one after the other, and where in memory each begins."""
    room = np.concatenate([np.ravel(array) for array in arrays], dtype=float)
    first, ends = room.ctypes.data, accumulate(array.size for array in arrays)
    return room, [first + room.itemsize * (e - a.size) for a, e in zip(arrays, ends, strict=True)]


@lru_cache(maxsize=TOPOLOGY_CACHE)
def compiled_kernel(topology: Topology) -> CompiledKernel:
    """Build or load the library of a topology; CompileError when that cannot be done."""

    def sources() -> dict[str, str]:
        functions = interpreted_functions(topology)
        out = {"driver": handwritten(MARCH_HEADER, DRIVER)}
        for name in (*MARCHED, "constants"):
            out |= c_sources(functions[name])
        return out

    path = library_of(topology, KERNEL_LIBRARY, sources, COMPILER_FLAGS)
    library = ctypes.CDLL(str(path))
    library.march.argtypes = MARCH_ARGUMENTS
    return CompiledKernel(path, library)
