"""Compiled kernels: generated C plus driver.c, loaded from a shared library."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.equilibria import Halt, March, Start, substeps
from doe_kc.solver.kernel import COMPILER_FLAGS, KERNEL_LIBRARY, MARCHED, Kernel, kernel
from doe_kc.solver.library import generate, library_of
from doe_kc.solver.newton import NewtonSettings

SUBSTEPS = 4
"""Equilibria a step, inside it and at its end, that a march with friction has room for at first."""
DRIVER = Path(__file__).with_name("driver.c")


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
        functions = kernel(topology).functions
        generated = {name: generate(functions[name]) for name in (*MARCHED, "constants")}
        return generated | {"driver": DRIVER.read_text()}

    path = library_of(topology, KERNEL_LIBRARY, sources, COMPILER_FLAGS)
    functions = [ca.external(name, str(path)) for name in MARCHED]
    return CompiledKernel(
        path,
        ctypes.CDLL(str(path)),
        max(f.sz_iw() for f in functions),
        max(f.sz_w() for f in functions),
    )
