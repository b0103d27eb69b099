"""Compiled sensitivities: sensitivity.c with the programs of a topology's derivatives.

Programs alone, not compiled code of the topology: carried out for a vector register of equilibria at once
they take less time than that for one after the other, by 2 to 17 % of all of `sensitivities` on the axles of
examples/, and nothing has to be compiled.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Mapping
from functools import lru_cache

import casadi as ca

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.solver.assembly import assemble
from doe_kc.solver.blocks import block_names
from doe_kc.solver.differentiation import derivatives
from doe_kc.solver.kernel import interpreted_functions
from doe_kc.solver.library import COMPILE_VARIABLE, CompileError
from doe_kc.solver.operations import operations_of
from doe_kc.solver.program import Program, program_from
from doe_kc.solver.program_library import (
    ProgramFunction,
    ProgramSet,
    point_lanes,
    programs_for,
    sensitivity_library,
)

_INT, _ADDRESS = ctypes.c_int, ctypes.c_void_p
_ARGUMENTS = (
    *(_INT,) * 4, *(_ADDRESS,) * 3, _INT, *(_ADDRESS,) * 3, _INT, *(_ADDRESS,) * 3, _INT, *(_ADDRESS,) * 2,
    _INT, *(_ADDRESS,) * 5,
)  # fmt: skip
"""Of `sensitivity` in sensitivity.c, in its order."""


class DerivativeLibrary:
    """The programs of a topology's derivatives and what carries them out; CompileError without a compiler."""

    def __init__(self, topology: Topology) -> None:
        programs = derivative_programs(topology)
        self._library = sensitivity_library()
        self._library.sensitivity.argtypes = _ARGUMENTS
        self._programs = ProgramSet([programs["derivatives"]], point_lanes())
        self.constants = ProgramFunction(programs["constants_block"])
        """See `constants_gradient`."""

    def sensitivity(self, *arguments: object) -> int:
        """Calls `sensitivity` of sensitivity.c; arguments and result are its own."""
        self._library.use_programs(self._programs.address)
        return int(self._library.sensitivity(*arguments))


def _made(topology: Topology) -> dict[str, Program]:
    eq = assemble(topology)
    dense = [ca.densify(part) for part in (eq.residual, eq.outputs, eq.next_state)]
    whole = operations_of(ca.Function("whole", [eq.x, eq.c, eq.u, eq.z], dense))
    blocks = [name for name in block_names(int(eq.z.numel()) > 0) if name != "constants"]
    places = [("RYZ".index(name[0]), "xcuz".index(name[2])) for name in blocks]
    constants = operations_of(interpreted_functions(topology)["constants"])
    return {
        "derivatives": program_from(derivatives(whole, places)),
        "constants_block": program_from(derivatives(constants, [(0, 0)])),
    }


@lru_cache(maxsize=TOPOLOGY_CACHE)
def derivative_programs(topology: Topology) -> Mapping[str, Program]:
    """Of `sensitivity`, all blocks of one point with what they have in common, and of the derivative of the
    constants; CompileError as `operations.operations_of`."""
    return programs_for(topology, "derivatives", lambda: _made(topology))


@lru_cache(maxsize=TOPOLOGY_CACHE)
def derivative_library(topology: Topology) -> DerivativeLibrary:
    """What differentiates a topology; CompileError when that cannot or shall not be built."""
    if os.environ.get(COMPILE_VARIABLE) == "0":
        raise CompileError(f"{COMPILE_VARIABLE} is 0")
    return DerivativeLibrary(topology)
