"""Compiled marches side by side: batch.c with a topology's C for lanes, or with its programs."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Protocol

import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.c_source import c_sources
from doe_kc.solver.compiled import SUBSTEPS
from doe_kc.solver.dialect import Dialect
from doe_kc.solver.elimination import EliminationOrder
from doe_kc.solver.equilibria import Substeps, substeps
from doe_kc.solver.instructions import InstructionSet, own_instruction_set
from doe_kc.solver.kernel import MARCHED, Kernel, interpreted_functions, kernel_operations, kernel_programs
from doe_kc.solver.library import COMPILE_VARIABLE, CompileError, library_of
from doe_kc.solver.library_on_demand import LibraryOnDemand
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.program import interpreter_source
from doe_kc.solver.program_library import (
    LANES_HEADER,
    MARCH_SOURCES,
    ProgramFunction,
    ProgramSet,
    lane_dialect,
    load_program_library,
)

BATCH_SOURCE = Path(__file__).with_name("batch.c")
NO_CONSTANTS = "#define NO_CONSTANTS\n"
"""Leaves `constants_batch` out."""
_INT, _DOUBLE, _ADDRESS = ctypes.c_int, ctypes.c_double, ctypes.c_void_p
_BATCH_ARGUMENTS = (
    *(_INT,) * 7, *(_ADDRESS,) * 2, _DOUBLE, _DOUBLE, *(_INT,) * 5, *(_ADDRESS,) * 10,
    _INT, _ADDRESS, _INT, _ADDRESS, _INT, *(_ADDRESS,) * 4, _INT, *(_ADDRESS,) * 9, _INT, *(_ADDRESS,) * 2,
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
class BatchProblem:
    """Equilibria that are asked for of d designs: at path coordinates s (d, n) under controls u (d, n, nu).

    c: (d, nc) constants. columns: of the outputs that are asked for. failed: (d,) designs to leave out.
    steps: (d,) of the n that each design has, None for all. path: whether `BatchMarch.path` is asked for.
    """

    c: FloatArray
    start: BatchStart
    s: FloatArray
    u: FloatArray
    columns: np.ndarray
    failed: np.ndarray
    settings: NewtonSettings
    steps: np.ndarray | None = None
    path: bool = False


@dataclass(frozen=True)
class BatchPath:
    """z: (d, n, nz) friction states after each step; counts: (d, 4) as in `equilibria.March`; between: of
    every design, of an axle with friction."""

    z: FloatArray
    counts: np.ndarray
    between: tuple[Substeps, ...] | None


@dataclass(frozen=True)
class BatchMarch:
    """x: (d, n, nx); y: (d, n, outputs asked for); z: (d, nz) after the last step.

    failed: (d,) whether a design has no such march; its rows hold nothing. counts: calls of residual,
    Jacobian, solution and outputs, each for all lanes. path: None unless asked for.
    """

    x: FloatArray
    y: FloatArray
    z: FloatArray
    failed: np.ndarray
    counts: np.ndarray
    path: BatchPath | None = None


class BatchMarcher(Protocol):
    """Marches designs of one topology side by side. lanes: how many at once."""

    @property
    def lanes(self) -> int: ...

    def constants(self, parameters: FloatArray) -> FloatArray:
        """(d, nc) constants of the internal parameters (d, np), by `layout.parameter_names`."""
        ...

    def march(self, kernel: Kernel, order: EliminationOrder, problem: BatchProblem) -> BatchMarch:
        """Equilibria of the designs, eliminated in the given order."""
        ...


@dataclass(frozen=True)
class BatchLibrary:
    """A loaded library of one topology. path: where it lies."""

    path: Path
    library: ctypes.CDLL
    lanes: int

    def constants(self, parameters: FloatArray) -> FloatArray:
        """See `BatchMarcher`."""
        given = np.ascontiguousarray(parameters, dtype=float)
        count = self.library.constants_count()
        out = np.zeros((len(given), count))
        self.library.constants_batch(*given.shape, count, given.ctypes.data, out.ctypes.data)
        return out

    def march(self, kernel: Kernel, order: EliminationOrder, problem: BatchProblem) -> BatchMarch:
        """See `BatchMarcher`."""
        return _march_by(self.library.march_batch, kernel, order, problem)


class AdaptiveBatch:
    """The programs of a topology, until so much has been asked of them that compiling pays.

    Both give the same numbers, digit for digit.
    """

    def __init__(self, topology: Topology, instructions: InstructionSet) -> None:
        self.topology, self._instructions = topology, instructions
        programs = kernel_programs(topology)
        self._library = _program_library(instructions)
        self._programs = ProgramSet([programs[name] for name in MARCHED], instructions.lanes)
        self._constants = ProgramFunction(programs["constants"])
        self.jacobian = ProgramFunction(programs["jacobian"])
        """(nnz,) of (x, c, u, z), of one design."""
        self._lengths = np.array([programs["residual"].length, programs["jacobian"].length])
        self._on_demand = LibraryOnDemand(
            topology,
            _kind(instructions),
            instructions.build_flags,
            lambda: batch_library(topology, instructions),
        )

    @property
    def lanes(self) -> int:
        return self._instructions.lanes

    @property
    def compiled(self) -> bool:
        """Whether it is the compiled kernel that marches."""
        return self._on_demand.ready

    def constants(self, parameters: FloatArray) -> FloatArray:
        """See `BatchMarcher`."""
        return np.array([self._constants(row).copy() for row in parameters])

    def march(self, kernel: Kernel, order: EliminationOrder, problem: BatchProblem) -> BatchMarch:
        """See `BatchMarcher`."""
        if (library := self._on_demand.library()) is not None:
            return library.march(kernel, order, problem)
        self._library.use_programs(self._programs.address)
        path = _march_by(self._library.march_batch, kernel, order, problem)
        self._on_demand.count(int(path.counts[:2] @ self._lengths))
        return path


def _march_by(
    function: Callable[..., int], kernel: Kernel, order: EliminationOrder, problem: BatchProblem
) -> BatchMarch:
    """function: `march_batch` of batch.c."""
    capacity = SUBSTEPS * problem.s.shape[1] if problem.path and kernel.nz else 0
    march, passed = _march_with(function, kernel, order, problem, capacity)
    if problem.path and passed.max() > capacity:
        march, _ = _march_with(function, kernel, order, problem, int(passed.max()))
    return march


def _march_with(
    function: Callable[..., int],
    kernel: Kernel,
    order: EliminationOrder,
    problem: BatchProblem,
    capacity: int,
) -> tuple[BatchMarch, np.ndarray]:
    """The march, with `capacity` of each design's substeps, and how many each had, (d,)."""
    start, settings = problem.start, problem.settings
    (d, n), (nx, nu, nz) = problem.s.shape, (kernel.nx, kernel.nu, kernel.nz)
    column = np.ascontiguousarray(problem.columns, dtype=np.int32)
    x, y, z = np.zeros((d, n, nx)), np.zeros((d, n, len(column))), np.array(start.z, order="C")
    verdict, counts = problem.failed.astype(np.int32), np.zeros(4, dtype=np.int64)
    steps = np.full(d, n, dtype=np.int32) if problem.steps is None else problem.steps.astype(np.int32)
    given = (problem.c, start.s, start.x, start.u, problem.s, problem.u)
    numbers = [np.ascontiguousarray(a, dtype=float) for a in given]
    c_in, s_known, x_known, u_start, s_in, u_in = (a.ctypes.data for a in numbers)
    rows, _, _, tail, scale, slips = kernel.addresses
    own, passed = np.zeros((d, 4), dtype=np.int64), np.zeros(d, dtype=np.int32)
    states = np.zeros((d, n, nz)) if problem.path else None
    between = np.empty((d, capacity, 2 + nu + nx + nz))
    code = function(
        *(nx, len(order.row_of), nu, nz, kernel.ny, numbers[0].shape[1], len(kernel.rows), tail, scale),
        *(settings.tol, settings.refresh, settings.max_iterations, settings.max_halvings),
        *(start.guess, kernel.coordinates, len(kernel.slips), slips),
        *(array.ctypes.data for array in order.arrays),
        *(rows, len(column), column.ctypes.data),
        *(d, c_in, start.s.shape[1], s_known, x_known, u_start, z.ctypes.data),
        *(n, steps.ctypes.data, s_in, u_in, x.ctypes.data, y.ctypes.data),
        *(verdict.ctypes.data, counts.ctypes.data, None if states is None else states.ctypes.data),
        *(own.ctypes.data, capacity, between.ctypes.data, passed.ctypes.data),
    )
    if code:
        raise MemoryError("the solver could not allocate its working memory")
    path = None
    if states is not None:
        kept = tuple(substeps(kernel, row[:k]) for row, k in zip(between, passed, strict=True))
        path = BatchPath(states, own, kept if nz else None)
    return BatchMarch(x, y, z, verdict > 0, counts, path), passed


def _dialect(instructions: InstructionSet) -> Dialect:
    return lane_dialect(instructions.defines + LANES_HEADER.read_text())


def _driver(dialect: Dialect) -> str:
    return dialect.before + MARCH_SOURCES[0].read_text() + BATCH_SOURCE.read_text()


def _batch_sources(topology: Topology, instructions: InstructionSet) -> dict[str, str]:
    functions, operations = interpreted_functions(topology), kernel_operations(topology)
    dialect = _dialect(instructions)
    out = {"batch": _driver(dialect)}
    for name in MARCHED:
        out |= c_sources(functions[name], dialect, operations[name])
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


@lru_cache(maxsize=TOPOLOGY_CACHE)
def adaptive_batch(topology: Topology, instructions: InstructionSet | None = None) -> AdaptiveBatch:
    """What marches designs of a topology side by side, by default for this processor; CompileError when that
    cannot or shall not be built."""
    if os.environ.get(COMPILE_VARIABLE) == "0":
        raise CompileError(f"{COMPILE_VARIABLE} is 0")
    return AdaptiveBatch(topology, instructions or own_instruction_set())


@lru_cache(maxsize=4)
def _program_library(instructions: InstructionSet) -> ctypes.CDLL:
    """The march and what carries programs out in lanes, the same for all topologies."""
    dialect = _dialect(instructions)
    sources = {"batch": NO_CONSTANTS + _driver(dialect), "program": interpreter_source(dialect)}
    library = load_program_library(sources, instructions.build_flags)
    library.march_batch.argtypes = _BATCH_ARGUMENTS
    return library
