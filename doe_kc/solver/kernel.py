"""Numerical functions of one topology, interpreted by CasADi or compiled from its generated C."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.assembly import assemble
from doe_kc.solver.equations import Equations


@dataclass(frozen=True)
class Kernel:
    """residual (nx,), jacobian (nnz,), outputs (ny,), state_update (nz,) of (x, c, u, z).

    constants: (nc,) of the parameters p.
    rows, cols: of the Jacobian's nonzeros. scale: (nx,) residual that weighs as much as 1 N.
    """

    topology: Topology
    equations: Equations
    functions: dict[str, ca.Function]
    constants: ca.Function
    rows: np.ndarray
    cols: np.ndarray
    scale: FloatArray

    @property
    def nx(self) -> int:
        return len(self.equations.unknowns)

    @property
    def nz(self) -> int:
        return int(self.equations.z.numel())

    @property
    def nu(self) -> int:
        return len(self.equations.control_names)

    @property
    def ny(self) -> int:
        return len(self.equations.output_names)

    def index(self, unknown: str) -> int:
        """Place of an unknown in x."""
        return [u.name for u in self.equations.unknowns].index(unknown)

    @property
    def slips(self) -> np.ndarray:
        """Places in x of the motions that friction resists."""
        return np.array([self.index(name) for name in self.equations.slips], dtype=np.int32)

    @property
    def tail_controls(self) -> np.ndarray:
        """Index of the control that prescribes each tail unknown."""
        names = {"pad L": "pad_L", "pad R": "pad_R", "preload": "preload"}
        tail = self.equations.unknowns[-self.equations.tail :]
        return np.array([self.equations.control_names.index(names[t.name]) for t in tail], dtype=np.int32)

    def constant_values(self, values: dict[str, float]) -> FloatArray:
        """(nc,) constants from the axle's internal values."""
        p = np.array([values[name] for name in self.equations.parameter_names])
        return np.asarray(self.constants(p)).ravel()


@lru_cache(maxsize=TOPOLOGY_CACHE)
def kernel(topology: Topology) -> Kernel:
    """The kernel of a topology (cached: a pure function of it)."""
    eq = assemble(topology)
    symbols = [eq.x, eq.c, eq.u, eq.z]
    jacobian = ca.jacobian(eq.residual, eq.x)

    def function(name: str, expression: ca.SX, *, cse: bool = True) -> ca.Function:
        return ca.Function(name, symbols, [expression], {"cse": cse})

    rows, cols = jacobian.sparsity().get_triplet()
    return Kernel(
        topology=topology,
        equations=eq,
        functions={
            "residual": function("residual", ca.densify(eq.residual)),
            # common subexpressions would save a seventh of its run time and cost a quarter of a second
            "jacobian": function("jacobian", jacobian, cse=False),
            "outputs": function("outputs", ca.densify(eq.outputs)),
            "state_update": function("state_update", ca.densify(eq.next_state)),
        },
        constants=ca.Function("constants", [eq.p], [ca.densify(eq.constants)], {"cse": True}),
        rows=np.array(rows, dtype=np.int32),
        cols=np.array(cols, dtype=np.int32),
        scale=np.array([u.scale for u in eq.unknowns]),
    )


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
