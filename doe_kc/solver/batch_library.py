"""Compiled kernels of several designs side by side: generated C for lanes plus batch.c."""

from __future__ import annotations

import ctypes
import os
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.c_source import LANE_EXPRESSIONS, Dialect, c_sources
from doe_kc.solver.elimination import EliminationOrder
from doe_kc.solver.instructions import InstructionSet, own_instruction_set
from doe_kc.solver.kernel import MARCHED, Kernel, kernel
from doe_kc.solver.library import COMPILE_VARIABLE, CompileError, library_of
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.program_library import MARCH_SOURCES

BATCH_SOURCE = Path(__file__).with_name("batch.c")
LANES_HEADER = Path(__file__).with_name("lanes.h")
_INT, _DOUBLE, _ADDRESS = ctypes.c_int, ctypes.c_double, ctypes.c_void_p
_BATCH_ARGUMENTS = (
    *(_INT,) * 7, *(_ADDRESS,) * 2, _DOUBLE, _DOUBLE, *(_INT,) * 5, *(_ADDRESS,) * 10,
    _INT, _ADDRESS, _INT, _ADDRESS, _INT, *(_ADDRESS,) * 4, _INT, *(_ADDRESS,) * 6,
)  # fmt: skip
"""Of `march_batch` in batch.c, in its order."""


@dataclass(frozen=True)
class BatchStart:
    """Known points of d designs before a march, newest last. s: (d, known); x: (d, known, nx); u: (d, nu) and
    z: (d, nz) of the newest. guess: as in `equilibria.Start`."""

    s: FloatArray
    x: FloatArray
    u: FloatArray
    z: FloatArray
    guess: bool = False


@dataclass(frozen=True)
class BatchMarch:
    """x: (d, n, nx); y: (d, n, outputs asked for); z: (d, nz) after the last step.

    failed: (d,) whether a design has no such march; its rows hold nothing. counts: calls of residual,
    Jacobian, solution and outputs, each for all lanes.
    """

    x: FloatArray
    y: FloatArray
    z: FloatArray
    failed: np.ndarray
    counts: np.ndarray


@dataclass(frozen=True)
class BatchLibrary:
    """A loaded library. path: where it lies."""

    path: Path
    library: ctypes.CDLL
    lanes: int

    def constants(self, kernel: Kernel, parameters: FloatArray) -> FloatArray:
        """(d, nc) constants of the internal parameters (d, np), by `layout.parameter_names`."""
        given = np.ascontiguousarray(parameters, dtype=float)
        count = self.library.constants_count()
        out = np.zeros((len(given), count))
        self.library.constants_batch(*given.shape, count, given.ctypes.data, out.ctypes.data)
        return out

    def march(
        self,
        kernel: Kernel,
        order: EliminationOrder,
        c: FloatArray,
        start: BatchStart,
        s: FloatArray,
        u: FloatArray,
        columns: np.ndarray,
        failed: np.ndarray,
        settings: NewtonSettings,
    ) -> BatchMarch:
        """Equilibria of d designs at path coordinates s (d, n) under the controls u (d, n, nu).

        columns: of the outputs that are asked for. failed: (d,) designs to leave out.
        """
        (d, n), (nx, nu, nz) = s.shape, (kernel.nx, kernel.nu, kernel.nz)
        x, y, z = np.zeros((d, n, nx)), np.zeros((d, n, len(columns))), np.array(start.z, order="C")
        verdict, counts = failed.astype(np.int32), np.zeros(4, dtype=np.int64)
        numbers = [np.ascontiguousarray(a, dtype=float) for a in (c, start.s, start.x, start.u, s, u)]
        c_in, s_known, x_known, u_start, s_in, u_in = (a.ctypes.data for a in numbers)
        column = np.ascontiguousarray(columns, dtype=np.int32)
        rows, _, tail, scale, slips = kernel.addresses
        code = self.library.march_batch(
            *(nx, len(order.row_of), nu, nz, kernel.ny, c.shape[1], len(kernel.rows), tail, scale),
            *(settings.tol, settings.refresh, settings.max_iterations, settings.max_halvings),
            *(start.guess, kernel.coordinates, len(kernel.slips), slips),
            *(array.ctypes.data for array in order.arrays),
            *(rows, len(column), column.ctypes.data),
            *(d, c_in, start.s.shape[1], s_known, x_known, u_start, z.ctypes.data),
            *(n, s_in, u_in, x.ctypes.data, y.ctypes.data, verdict.ctypes.data, counts.ctypes.data),
        )
        if code:
            raise MemoryError("the solver could not allocate its working memory")
        return BatchMarch(x, y, z, verdict > 0, counts)


def _batch_sources(topology: Topology, instructions: InstructionSet) -> dict[str, str]:
    functions = kernel(topology).functions
    before = instructions.defines + LANES_HEADER.read_text()
    dialect = Dialect("lane", "lane_of({0})", LANE_EXPRESSIONS, before)
    out = {"batch": before + MARCH_SOURCES[0].read_text() + BATCH_SOURCE.read_text()}
    for name in MARCHED:
        out |= c_sources(functions[name], dialect)
    count = functions["constants"].nnz_out(0)
    out |= c_sources(functions["constants"])
    out["constants"] += f"int constants_count(void) {{ return {count}; }}\n"
    return out


def _kind(instructions: InstructionSet) -> str:
    return f"batch kernel, {instructions.name}"


@lru_cache(maxsize=TOPOLOGY_CACHE)
def batch_library(topology: Topology, instructions: InstructionSet | None = None) -> BatchLibrary:
    """Build or load the library of a topology, by default for this processor; CompileError when that cannot
    or shall not be done."""
    if os.environ.get(COMPILE_VARIABLE) == "0":
        raise CompileError(f"{COMPILE_VARIABLE} is 0")
    chosen = instructions or own_instruction_set()
    path = library_of(topology, _kind(chosen), lambda: _batch_sources(topology, chosen), chosen.build_flags)
    library = ctypes.CDLL(str(path))
    library.march_batch.argtypes = _BATCH_ARGUMENTS
    library.constants_batch.argtypes = (*(_INT,) * 3, *(_ADDRESS,) * 2)
    return BatchLibrary(path, library, chosen.lanes)
