"""Programs carried out by compiled libraries that are the same for all topologies."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import casadi as ca
import numpy as np

from doe_kc.axle.topology import Topology
from doe_kc.ground.garbage_collection import no_garbage_collection
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.dialect import LANE_EXPRESSIONS, Dialect
from doe_kc.solver.instructions import own_instruction_set
from doe_kc.solver.library import build, handwritten, store_bytes, stored_bytes
from doe_kc.solver.program import Program, interpreter_source, programs_bytes, read_programs

MARCH_SOURCES = (Path(__file__).with_name("march.h"), Path(__file__).with_name("driver.c"))
"""Of the compiled march; the header has the constants of march.py and newton.py."""
SENSITIVITY = Path(__file__).with_name("sensitivity.c")
LANES_HEADER = Path(__file__).with_name("lanes.h")
PROGRAM_FLAGS = {"program": "-O2 -ffp-contract=off"}
ALIGNMENT = 8
"""Numbers: of the largest vector registers."""
_ADDRESS = ctypes.c_void_p


class _Record(ctypes.Structure):
    """`program` of program.c."""

    _fields_ = (
        *((name, ctypes.c_int) for name in ("inputs", "runs", "results")),
        *(
            (name, _ADDRESS)
            for name in ("size", "run", "operand", "result", "pattern", "pattern_start", "place")
        ),
    )


@lru_cache(maxsize=1)
def march_library() -> ctypes.CDLL:
    """The march of driver.c and what carries programs out; CompileError when it cannot be built."""
    sources = {"driver": handwritten(*MARCH_SOURCES), "program": interpreter_source()}
    library = load_program_library(sources, {"driver": "-O3", **PROGRAM_FLAGS})
    library.run_program.argtypes = (_ADDRESS, _ADDRESS, _ADDRESS)
    return library


@lru_cache(maxsize=1)
def sensitivity_library() -> ctypes.CDLL:
    """sensitivity.c and what carries programs out, for as many points side by side as `point_lanes`.

    Functions are those of the C library, lane by lane: its vector library's are right within 4 units in the
    last place only.
    """
    instructions = replace(own_instruction_set(), library=False)
    lanes = instructions.defines + LANES_HEADER.read_text()
    sources = {
        "sensitivity": lanes + SENSITIVITY.read_text(),
        "program": interpreter_source(lane_dialect(lanes)),
    }
    flags = {"sensitivity": "-O3", **PROGRAM_FLAGS}
    return load_program_library(
        sources, {part: " ".join((own, *instructions.flags)) for part, own in flags.items()}
    )


def point_lanes() -> int:
    """Equilibria whose derivatives programs compute side by side."""
    return own_instruction_set().lanes


def lane_dialect(header: str) -> Dialect:
    """Of numbers side by side. header: lanes.h with what it wants to know."""
    return Dialect("lane", "lane_of({0})", LANE_EXPRESSIONS, header)


def load_program_library(sources: dict[str, str], flags: Mapping[str, str]) -> ctypes.CDLL:
    """Build and load what carries programs out, program.c among the sources; CompileError as `build`."""
    library = ctypes.CDLL(str(build(sources, flags)))
    library.use_programs.argtypes = (_ADDRESS,)
    library.use_programs.restype = None
    return library


def programs_for(
    topology: Topology, kind: str, make: Callable[[], Mapping[str, Program]]
) -> Mapping[str, Program]:
    """Programs of one kind of a topology's functions, from the user's cache or made and kept there."""
    content = stored_bytes(topology, kind)
    if content is not None:
        with suppress(ValueError):
            return read_programs(content)
    with no_garbage_collection():
        programs = make()
    store_bytes(topology, kind, programs_bytes(programs))
    return programs


class ProgramSet:
    """Programs in a row, as program.c reads them; every thread has places of its own.

    lanes: designs side by side, each number being as many in a row.
    """

    def __init__(self, programs: Sequence[Program], lanes: int = 1) -> None:
        self._programs, self._lanes = tuple(programs), lanes
        self._own = threading.local()

    @property
    def address(self) -> int:
        """In memory, for this thread."""
        if not hasattr(self._own, "records"):
            self._own.places = [_places(p, self._lanes) for p in self._programs]
            pairs = zip(self._programs, self._own.places, strict=True)
            self._own.records = (_Record * len(self._programs))(*(_record(p, place) for p, place in pairs))
        return ctypes.addressof(self._own.records)


def _places(program: Program, lanes: int) -> FloatArray:
    """(places, lanes), those of the constants filled."""
    count = int(program.places[0]) * lanes
    room = np.zeros(count + ALIGNMENT)
    start = -(room.ctypes.data // room.itemsize) % ALIGNMENT
    out = room[start : start + count].reshape(-1, lanes)
    first = int(program.sizes.sum())
    out[first : first + len(program.constants)] = program.constants[:, None]
    return out


def _record(program: Program, places: FloatArray) -> _Record:
    arrays = (program.sizes, program.runs, program.operands, program.results, program.patterns)
    counts = (len(program.sizes), len(program.runs), len(program.results))
    return _Record(*counts, *(a.ctypes.data for a in (*arrays, program.pattern_starts, places)))


@dataclass
class _Buffers:
    """Of one thread."""

    arguments: list[FloatArray]
    result: FloatArray
    argument_addresses: ctypes.Array[ctypes.c_void_p]
    result_addresses: ctypes.Array[ctypes.c_void_p]


class ProgramFunction:
    """One program of a single result, called with its arguments; CompileError as `march_library`."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._library = march_library()
        self._set = ProgramSet([program])
        self._own = threading.local()

    def sparsity_out(self, result: int) -> ca.Sparsity:
        """Pattern of the result, as CasADi's functions have it."""
        return self._program.pattern(result)

    def __call__(self, *arguments: FloatArray) -> FloatArray:
        """Nonzeros of the result in a buffer that the thread's next call overwrites."""
        buffers = self._buffers()
        for array, value in zip(buffers.arguments, arguments, strict=True):
            if array.size:
                array[:] = value
        self._library.run_program(self._set.address, buffers.argument_addresses, buffers.result_addresses)
        return buffers.result

    def _buffers(self) -> _Buffers:
        if not hasattr(self._own, "buffers"):
            arguments = [np.zeros(size) for size in self._program.sizes]
            result = np.zeros(self.sparsity_out(0).nnz())
            self._own.buffers = _Buffers(
                arguments,
                result,
                (ctypes.c_void_p * len(arguments))(*(a.ctypes.data for a in arguments)),
                (ctypes.c_void_p * 1)(result.ctypes.data),
            )
        buffers: _Buffers = self._own.buffers
        return buffers
