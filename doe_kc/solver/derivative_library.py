"""Compiled sensitivities: sensitivity.c with a topology's generated C, or with programs until that pays."""

from __future__ import annotations

import ctypes
import os
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Protocol

import casadi as ca

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.solver.blocks import block_names, interpreted_blocks
from doe_kc.solver.c_source import c_sources
from doe_kc.solver.kernel import kernel
from doe_kc.solver.library import COMPILE_VARIABLE, CompileError, library_of
from doe_kc.solver.library_on_demand import LibraryOnDemand
from doe_kc.solver.program import Program
from doe_kc.solver.program_library import (
    SENSITIVITY,
    ProgramFunction,
    ProgramSet,
    programs_for,
    sensitivity_flags,
    sensitivity_library,
)

DERIVATIVE_LIBRARY = "derivatives"
"""Kind of the library of a topology's derivatives."""
_INT, _ADDRESS = ctypes.c_int, ctypes.c_void_p
_ARGUMENTS = (
    *(_INT,) * 4, *(_ADDRESS,) * 3, _INT, *(_ADDRESS,) * 3, _INT, *(_ADDRESS,) * 3, _INT, *(_ADDRESS,) * 6,
)  # fmt: skip
"""Of `sensitivity` in sensitivity.c, in its order."""


class SensitivityLibrary(Protocol):
    """Calls `sensitivity` of sensitivity.c for one topology."""

    def sensitivity(self, points: int, *arguments: object) -> int:
        """points: equilibria of the call; arguments and result: of `sensitivity`."""
        ...


@dataclass(frozen=True)
class DerivativeLibrary:
    """A loaded library of one topology's derivatives. path: where it lies."""

    path: Path
    library: ctypes.CDLL

    @cached_property
    def constants(self) -> ca.Function:
        """See `constants_gradient`."""
        return ca.external("constants_block", str(self.path))

    def sensitivity(self, points: int, *arguments: object) -> int:
        """See `SensitivityLibrary`."""
        del points
        return int(self.library.sensitivity(*arguments))


class AdaptiveDerivatives:
    """The programs of a topology's derivatives, until so much has been asked of them that compiling pays.

    Both give the same numbers, digit for digit.
    """

    def __init__(self, topology: Topology) -> None:
        programs = derivative_programs(topology)
        self._library = sensitivity_library()
        self._library.sensitivity.argtypes = _ARGUMENTS
        self._programs = ProgramSet([programs["derivatives"]])
        self._length = programs["derivatives"].length
        self.constants = ProgramFunction(programs["constants_block"])
        self._on_demand = LibraryOnDemand(
            topology, DERIVATIVE_LIBRARY, sensitivity_flags(), lambda: derivative_library(topology)
        )

    @property
    def compiled(self) -> bool:
        """Whether the derivatives are compiled ones."""
        return self._on_demand.ready

    def compile(self) -> None:
        """Compile now; where that fails, the programs go on."""
        self._on_demand.make()

    def sensitivity(self, points: int, *arguments: object) -> int:
        """See `SensitivityLibrary`."""
        if (library := self._on_demand.library()) is not None:
            return library.sensitivity(points, *arguments)
        self._library.use_programs(self._programs.address)
        self._on_demand.count(points * self._length)
        return int(self._library.sensitivity(*arguments))


def _derivative_functions(topology: Topology) -> dict[str, ca.Function]:
    """All blocks of one point with what they have in common, and the derivative of the constants."""
    blocks = interpreted_blocks(topology)
    symbols = blocks["R_x"].sx_in()
    names = [n for n in block_names(kernel(topology).nz > 0) if n != "constants"]
    joint = ca.Function("derivatives", symbols, [blocks[n](*symbols) for n in names], {"cse": True})
    return {"derivatives": joint, "constants_block": blocks["constants"]}


@lru_cache(maxsize=TOPOLOGY_CACHE)
def derivative_programs(topology: Topology) -> dict[str, Program]:
    """Of `sensitivity`, and of the derivative of the constants."""
    return programs_for(topology, DERIVATIVE_LIBRARY, lambda: _derivative_functions(topology))


@lru_cache(maxsize=TOPOLOGY_CACHE)
def adaptive_derivatives(topology: Topology) -> AdaptiveDerivatives:
    """What differentiates a topology; CompileError when that cannot or shall not be built."""
    if os.environ.get(COMPILE_VARIABLE) == "0":
        raise CompileError(f"{COMPILE_VARIABLE} is 0")
    return AdaptiveDerivatives(topology)


@lru_cache(maxsize=TOPOLOGY_CACHE)
def derivative_library(topology: Topology) -> DerivativeLibrary:
    """Build or load the library of a topology; CompileError when that cannot be done."""

    def sources() -> dict[str, str]:
        functions = _derivative_functions(topology).values()
        generated = {part: text for function in functions for part, text in c_sources(function).items()}
        return generated | {"sensitivity": SENSITIVITY.read_text()}

    path = library_of(topology, DERIVATIVE_LIBRARY, sources, sensitivity_flags())
    library = ctypes.CDLL(str(path))
    library.sensitivity.argtypes = _ARGUMENTS
    return DerivativeLibrary(path, library)
