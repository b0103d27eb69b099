"""Derivatives of consecutive equilibria of one axle to parameters: in Python, or one call of compiled code.

R(x, c, u, z) = 0 at an equilibrium, so dx = -J^-1 (R_c dc + R_u du + R_z dz); the outputs and the friction
states after it follow. The parameters move the constants c, and the controls u by directions of the datum.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import casadi as ca
import numpy as np
from scipy import sparse

from doe_kc.axle.topology import Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.blocks import SINGULAR_EQUILIBRIUM, Block, Points, equilibrium_change, interpreted_blocks
from doe_kc.solver.derivative_library import DerivativeLibrary, derivative_library
from doe_kc.solver.kernel import Kernel, kernel
from doe_kc.solver.library import CompileError
from doe_kc.solver.program_library import ProgramFunction


@dataclass(frozen=True)
class StateSequence:
    """n consecutive equilibria. x: (n, nx); u: (n, nu); z: (n, nz) friction states before each.

    gradient: (n, nu, d) derivative of the controls to d directions; wanted: (n,) whose outputs are asked for.
    """

    x: FloatArray
    u: FloatArray
    z: FloatArray
    gradient: FloatArray
    wanted: np.ndarray


@dataclass(frozen=True)
class StateDerivatives:
    """To np parameters. dx: (n, nx, np), empty unless asked for; dy: (1 + wanted, kept, np) of the outputs
    that are kept, row 0 of what the sequence starts from; dz: (nz, np) after the last."""

    dx: FloatArray
    dy: FloatArray
    dz: FloatArray


class Derivatives(Protocol):
    """Derivatives of the equilibria of one axle, whose constants c move with the parameters by dc."""

    def along(
        self,
        states: StateSequence,
        directions: FloatArray,
        kept: np.ndarray,
        dy: FloatArray,
        dz: FloatArray,
        *,
        unknowns: bool = False,
    ) -> StateDerivatives:
        """directions: (d, np) derivatives of the directions; kept: places of the outputs asked for; dy:
        (kept, np), dz: (nz, np) those of the outputs and friction states before the first; unknowns: whether
        dx is asked for. LinAlgError where an equilibrium is singular.
        """
        ...


def derivatives_of(topology: Topology, c: FloatArray, dc: sparse.csr_array) -> Derivatives:
    """By compiled code where that can be done. c: (nc,) constants; dc: (nc, np) their derivatives."""
    try:
        return CompiledDerivatives(kernel(topology), c, dc, derivative_library(topology))
    except CompileError:
        return InterpretedDerivatives(kernel(topology), c, dc)


def constants_gradient(topology: Topology) -> ca.Function | ProgramFunction:
    """(nc, internal parameters) derivative of the constants."""
    try:
        return derivative_library(topology).constants
    except CompileError:
        return interpreted_blocks(topology)["constants"]


class InterpretedDerivatives:
    """Block after block, by CasADi and NumPy."""

    def __init__(self, k: Kernel, c: FloatArray, dc: sparse.csr_array) -> None:
        self._kernel, self._c, self._dc = k, c, dc
        self._block = {n: Block(f) for n, f in interpreted_blocks(k.topology).items() if n != "constants"}
        self._parts = ("R", "Y", "Z") if k.nz else ("R", "Y")

    def along(
        self,
        states: StateSequence,
        directions: FloatArray,
        kept: np.ndarray,
        dy: FloatArray,
        dz: FloatArray,
        *,
        unknowns: bool = False,
    ) -> StateDerivatives:
        """See `Derivatives.along`."""
        block, du = self._block, states.gradient @ directions
        points: Points = [(x, self._c, u, z) for x, u, z in zip(states.x, states.u, states.z, strict=True)]
        explicit = {
            p: block[f"{p}_c"].times(points, self._dc) + block[f"{p}_u"].times_each(points, du)
            for p in self._parts
        }
        matrix = block["R_x"].dense(points)
        if self._kernel.nz:
            dx, before, dz = self._carried(points, matrix, explicit, dz)
        else:
            dx = equilibrium_change(self._kernel, matrix, explicit["R"])
        outputs = explicit["Y"] + block["Y_x"].times_each(points, dx)
        if self._kernel.nz:
            outputs += block["Y_z"].times_each(points, before)
        outputs = np.concatenate([dy[None], outputs[states.wanted][:, kept]])
        return StateDerivatives(dx if unknowns else dx[:0], outputs, dz)

    def _carried(
        self, points: Points, matrix: FloatArray, explicit: dict[str, FloatArray], dz: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, ., np) dx of each equilibrium and dz before it, and dz after the last.

        matrix: (n, nx, nx); explicit: what moves with the parameters directly; dz: before the first. One
        point after the other: the states, some hundred with rubber, never become right-hand sides.
        """
        blocks_each = (self._block[name].each(points) for name in ("R_z", "Z_x", "Z_z"))
        dx, before = np.empty_like(explicit["R"]), np.empty((len(points), *dz.shape))
        for i, (r_z, z_x, z_z) in enumerate(zip(*blocks_each, strict=True)):
            before[i] = dz
            dx[i] = equilibrium_change(self._kernel, matrix[i], explicit["R"][i] + r_z @ dz)
            dz = explicit["Z"][i] + z_x @ dx[i] + z_z @ dz
        return dx, before, dz


@dataclass(frozen=True)
class CompiledDerivatives:
    """All points of a sequence in one call: one factorization a point for all parameters."""

    kernel: Kernel
    c: FloatArray
    dc: sparse.csr_array
    library: DerivativeLibrary

    @cached_property
    def _sparse(self) -> tuple[np.ndarray, np.ndarray, FloatArray]:
        """dc: where its rows start, its columns, its values."""
        start, column = (np.ascontiguousarray(a, dtype=np.int32) for a in (self.dc.indptr, self.dc.indices))
        return start, column, np.ascontiguousarray(self.dc.data, dtype=float)

    def along(
        self,
        states: StateSequence,
        directions: FloatArray,
        kept: np.ndarray,
        dy: FloatArray,
        dz: FloatArray,
        *,
        unknowns: bool = False,
    ) -> StateDerivatives:
        """See `Derivatives.along`."""
        k, n, columns = self.kernel, len(states.x), self.dc.shape[1]
        place = np.where(states.wanted, np.cumsum(states.wanted), -1).astype(np.int32)
        outputs = np.empty((1 + np.count_nonzero(states.wanted), len(kept), columns))
        outputs[0] = dy
        dx = np.empty((n if unknowns else 0, k.nx, columns))
        after = np.array(dz, dtype=float, order="C")
        x, u, z, gradient, way = (
            np.ascontiguousarray(a, dtype=float)
            for a in (states.x, states.u, states.z, states.gradient, directions)
        )
        start, column, value = (a.ctypes.data for a in self._sparse)
        own = np.ascontiguousarray(kept, dtype=np.int32)
        code = self.library.sensitivity(
            *(k.nx, k.nu, k.nz, k.ny, k.scale.ctypes.data, k.layout.order.ctypes.data, self.c.ctypes.data),
            *(n, x.ctypes.data, u.ctypes.data, z.ctypes.data, columns, start, column, value),
            *(len(way), way.ctypes.data, gradient.ctypes.data, len(kept), own.ctypes.data, place.ctypes.data),
            *(outputs.ctypes.data, dx.ctypes.data if unknowns else None, after.ctypes.data),
        )
        if code < 0:
            raise MemoryError("the derivatives could not allocate their working memory")
        if code:
            raise np.linalg.LinAlgError(SINGULAR_EQUILIBRIUM)
        return StateDerivatives(dx, outputs, after)
