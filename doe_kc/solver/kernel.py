"""Numerical functions of one topology, interpreted by CasADi or compiled from its generated C."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, lru_cache

import casadi as ca
import numpy as np

from doe_kc.axle.topology import EQUATIONS_CACHE, TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.assembly import assemble
from doe_kc.solver.builder import FORCE_SCALE
from doe_kc.solver.differentiation import derivatives
from doe_kc.solver.layout import EquationLayout, layout_of, layout_text, read_layout
from doe_kc.solver.library import COMPILE_VARIABLE, CompileError, store_text, stored_library, stored_text
from doe_kc.solver.operations import Operations, operations_of
from doe_kc.solver.program import Program, program_from
from doe_kc.solver.program_library import ProgramFunction, programs_for

COMPILER_FLAGS = {"driver": "-O3"}
"""By part; the rest -O1."""
MARCHED = ("residual", "jacobian", "outputs", "state_update")
"""Functions of (x, c, u, z) that a kernel's library holds, beside `constants` and the driver."""
KERNEL_LIBRARY = "kernel"
"""Kind of a kernel's library."""


@dataclass(frozen=True)
class Kernel:
    """Numbers of one topology's equations: residual (nx,), jacobian (nnz,), outputs (ny,), state_update (nz,)
    of (x, c, u, z).

    Its equations are assembled when their expressions are asked for: a loaded library does without.
    """

    topology: Topology
    layout: EquationLayout

    @cached_property
    def functions(self) -> dict[str, ca.Function]:
        """Interpreted ones by name, kept as long as the kernel."""
        return interpreted_functions(self.topology)

    @cached_property
    def constants(self) -> ca.Function | ProgramFunction:
        """(nc,) of the parameters p; compiled where the kernel's library is there already."""
        if os.environ.get(COMPILE_VARIABLE) != "0":
            with suppress(CompileError):
                path = stored_library(self.topology, KERNEL_LIBRARY, COMPILER_FLAGS)
                if path is not None:
                    return ca.external("constants", str(path))
                return ProgramFunction(kernel_programs(self.topology)["constants"])
        return self.functions["constants"]

    @cached_property
    def scale(self) -> FloatArray:
        """(nx,) residual that weighs as much as 1 N."""
        return np.array([u.scale for u in self.layout.unknowns])

    @property
    def rows(self) -> np.ndarray:
        """(nnz,) of the Jacobian's nonzeros."""
        return self.layout.rows

    @property
    def cols(self) -> np.ndarray:
        """(nnz,) of the Jacobian's nonzeros."""
        return self.layout.cols

    @property
    def nx(self) -> int:
        return len(self.layout.unknowns)

    @property
    def nz(self) -> int:
        return self.layout.states

    @property
    def nu(self) -> int:
        return len(self.layout.control_names)

    @property
    def ny(self) -> int:
        return len(self.layout.output_names)

    @cached_property
    def coordinates(self) -> int:
        """How many unknowns, the first, are displacements and turns; constraint forces and tail follow."""
        moving = self.scale[: self.nx - self.layout.tail] >= FORCE_SCALE
        return len(moving) if moving.all() else int(np.argmin(moving))

    def index(self, unknown: str) -> int:
        """Place of an unknown in x."""
        return [u.name for u in self.layout.unknowns].index(unknown)

    @cached_property
    def slips(self) -> np.ndarray:
        """Places in x of the motions that friction resists."""
        return np.array([self.index(name) for name in self.layout.slips], dtype=np.int32)

    @cached_property
    def tail_controls(self) -> np.ndarray:
        """Index of the control that prescribes each tail unknown."""
        names = {"pad L": "pad_L", "pad R": "pad_R", "preload": "preload"}
        tail = self.layout.unknowns[-self.layout.tail :]
        return np.array([self.layout.control_names.index(names[t.name]) for t in tail], dtype=np.int32)

    @cached_property
    def addresses(self) -> tuple[int, int, int, int, int, int]:
        """In memory: rows, cols, order, tail_controls, scale, slips, for compiled code."""
        order = self.layout.order
        rows, cols, at, tail, scale, slips = (
            a.ctypes.data for a in (self.rows, self.cols, order, self.tail_controls, self.scale, self.slips)
        )
        return rows, cols, at, tail, scale, slips

    def constant_values(self, values: dict[str, float]) -> FloatArray:
        """(nc,) constants from the axle's internal values."""
        p = np.array([values[name] for name in self.layout.parameter_names])
        return evaluator(self.constants)(p).copy()


@lru_cache(maxsize=EQUATIONS_CACHE)
def interpreted_functions(topology: Topology) -> dict[str, ca.Function]:
    """Functions of a topology's expressions by name: those of `MARCHED`, and `constants`."""
    eq = assemble(topology)
    symbols = [eq.x, eq.c, eq.u, eq.z]

    def function(name: str, expression: ca.SX, *, cse: bool = True) -> ca.Function:
        return ca.Function(name, symbols, [expression], {"cse": cse})

    return {
        "residual": function("residual", ca.densify(eq.residual)),
        # common subexpressions would save a seventh of its run time and cost a quarter of a second
        "jacobian": function("jacobian", ca.jacobian(eq.residual, eq.x), cse=False),
        "outputs": function("outputs", ca.densify(eq.outputs)),
        "state_update": function("state_update", ca.densify(eq.next_state)),
        "constants": ca.Function("constants", [eq.p], [ca.densify(eq.constants)], {"cse": True}),
    }


def kernel_operations(topology: Topology) -> dict[str, Operations]:
    """Of the functions of `MARCHED`, and of `constants`; CompileError as `operations.operations_of`.

    The Jacobian as `derivatives` has it, three quarters as long as CasADi's; digits differ by rounding.
    """
    functions = interpreted_functions(topology)
    out = {name: operations_of(f) for name, f in functions.items() if name != "jacobian"}
    jacobian = derivatives(out["residual"], [(0, 0)])
    if jacobian.patterns[0] != functions["jacobian"].sparsity_out(0):
        jacobian = operations_of(functions["jacobian"])
    return {**out, "jacobian": jacobian}


@lru_cache(maxsize=TOPOLOGY_CACHE)
def kernel_programs(topology: Topology) -> Mapping[str, Program]:
    """The same as programs; CompileError as `kernel_operations`."""
    return programs_for(
        topology,
        KERNEL_LIBRARY,
        lambda: {name: program_from(whole) for name, whole in kernel_operations(topology).items()},
    )


@lru_cache(maxsize=TOPOLOGY_CACHE)
def kernel(topology: Topology) -> Kernel:
    """The kernel of a topology (cached: a pure function of it); its layout comes from the user's cache."""
    text = stored_text(topology, "layout")
    if text is not None:
        with suppress(ValueError, KeyError, TypeError):
            return Kernel(topology, read_layout(text))
    rows, cols = interpreted_functions(topology)["jacobian"].sparsity_out(0).get_triplet()
    layout = layout_of(assemble(topology), np.array(rows), np.array(cols))
    store_text(topology, "layout", layout_text(layout))
    return Kernel(topology, layout)


class Buffered:
    """A CasADi function called through fixed buffers: a fraction of a microsecond of overhead."""

    def __init__(self, function: ca.Function) -> None:
        self._inputs = [np.zeros(max(1, function.nnz_in(i))) for i in range(function.n_in())]
        self._sizes = [function.nnz_in(i) for i in range(function.n_in())]
        self.result = np.zeros(max(1, function.nnz_out(0)))
        self._buffer, self._evaluate = function.buffer()
        for i, array in enumerate(self._inputs):
            self._buffer.set_arg(i, memoryview(array))  # type: ignore[call-arg, arg-type]  # CasADi mis-stubs it
        self._buffer.set_res(0, memoryview(self.result))  # type: ignore[call-arg, arg-type]
        self._size = function.nnz_out(0)

    def __call__(self, *arguments: FloatArray) -> FloatArray:
        """Result in a buffer that the next call overwrites."""
        for array, size, value in zip(self._inputs, self._sizes, arguments, strict=True):
            if size:
                array[:size] = value
        self._evaluate()
        return self.result[: self._size]


def evaluator(function: ca.Function | ProgramFunction) -> Buffered | ProgramFunction:
    """What evaluates a function's only result, in a buffer that the next call overwrites."""
    return function if isinstance(function, ProgramFunction) else Buffered(function)
