"""Derivative blocks of one topology's equations: symbolic once, in numbers at every equilibrium."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

import casadi as ca
import numpy as np
from scipy import sparse

from doe_kc.axle.topology import EQUATIONS_CACHE, TOPOLOGY_CACHE, Topology
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.assembly import assemble
from doe_kc.solver.kernel import Kernel, evaluator, interpreted_functions, kernel, kernel_programs
from doe_kc.solver.library import COMPILE_VARIABLE, CompileError
from doe_kc.solver.program import Program, program_of
from doe_kc.solver.program_library import ProgramFunction, programs_for

Points = Sequence[tuple[FloatArray, ...]]
"""(x, c, u, z) of equilibria."""
SINGULAR_EQUILIBRIUM = "singular equilibrium: no sensitivity exists"


@lru_cache(maxsize=TOPOLOGY_CACHE)
def blocks(topology: Topology) -> Mapping[str, ca.Function | ProgramFunction]:
    """Derivative functions by block name, of those to x, u and z: R_x is d(residual)/dx, and so on.

    Programs where there is a C compiler: CasADi interprets them six times as slowly.
    """
    if os.environ.get(COMPILE_VARIABLE) == "0":
        return interpreted_blocks(topology)
    names = [n for n in block_names(kernel(topology).nz > 0) if n.endswith(("_x", "_u", "_z"))]

    def make() -> dict[str, Program]:
        return {name: program_of(interpreted_blocks(topology)[name]) for name in names if name != "R_x"}

    try:
        jacobian = kernel_programs(topology)["jacobian"]
        programs = {**programs_for(topology, "blocks", make), "R_x": jacobian}
        return {name: ProgramFunction(programs[name]) for name in names}
    except CompileError:
        return interpreted_blocks(topology)


def block_names(states: bool) -> list[str]:
    """Names of all blocks, in the order of sensitivity.c. states: whether there are friction states z."""
    plain = ["R_x", "R_c", "R_u", "Y_x", "Y_c", "Y_u"]
    return [*plain, *(("R_z", "Y_z", "Z_x", "Z_c", "Z_u", "Z_z") if states else ()), "constants"]


def _function(name: str) -> str:
    return f"{name}_block"


@lru_cache(maxsize=EQUATIONS_CACHE)
def interpreted_blocks(topology: Topology) -> Mapping[str, ca.Function]:
    """The same as symbolic expressions have them."""
    k = kernel(topology)
    eq = assemble(topology)
    symbols = [eq.x, eq.c, eq.u, eq.z]
    of = {"R": eq.residual, "Y": eq.outputs, "Z": eq.next_state}
    by = {"x": eq.x, "c": eq.c, "u": eq.u, "z": eq.z}
    out = {
        name: ca.Function(_function(name), symbols, [ca.jacobian(of[name[0]], by[name[2]])])
        for name in block_names(k.nz > 0)
        if name not in ("R_x", "constants")
    }
    out["R_x"] = interpreted_functions(topology)["jacobian"]
    out["constants"] = ca.Function(_function("constants"), [eq.p], [ca.jacobian(eq.constants, eq.p)])
    return out


class Block:
    """A sparse derivative block evaluated through buffers."""

    def __init__(self, function: ca.Function | ProgramFunction) -> None:
        pattern = function.sparsity_out(0)
        self._evaluate = evaluator(function)
        row, col = (np.array(places, dtype=int) for places in pattern.get_triplet())
        self._by_row = np.lexsort((col, row))
        self._row, self._col = row[self._by_row], col[self._by_row]
        self._shape = pattern.shape

    def __call__(self, *arguments: FloatArray) -> FloatArray:
        """The dense block at one point."""
        out = np.zeros(self._shape, order="F")
        out[self._row, self._col] = self._evaluate(*arguments)[self._by_row]
        return out

    def at(self, points: Points) -> FloatArray:
        """(n, nonzeros) by row at many points: one block after the other keeps its long code in the cache."""
        values = [self._evaluate(*point)[self._by_row] for point in points]
        return np.array(values).reshape(len(points), -1)

    def dense(self, points: Points) -> FloatArray:
        """(n, rows, columns) at many points."""
        out = np.zeros((len(points), *self._shape))
        out[:, self._row, self._col] = self.at(points)
        return out

    def each(self, points: Points) -> Iterator[sparse.csr_array]:
        """The sparse block at one point after the other: one matrix, whose numbers change."""
        ends = np.concatenate([[0], np.cumsum(np.bincount(self._row, minlength=self._shape[0]))])
        matrix = sparse.csr_array((np.zeros(self._col.size), self._col, ends), shape=self._shape)
        for values in self.at(points):
            matrix.data = values
            yield matrix

    def times(self, points: Points, right: sparse.csr_array) -> FloatArray:
        """(n, rows, m) products of the blocks at many points with one sparse matrix (columns, m)."""
        n, (rows, columns) = len(points), self._shape
        stacked = self._assembled(self.at(points), 0, columns)
        return np.asarray((stacked @ right).toarray()).reshape(n, rows, right.shape[1])

    def times_each(self, points: Points, right: FloatArray) -> FloatArray:
        """(n, rows, m) products of the blocks at many points with a dense matrix each, (n, columns, m)."""
        n, (rows, columns) = len(points), self._shape
        diagonal = self._assembled(self.at(points), columns, n * columns)
        return np.asarray(diagonal @ right.reshape(n * columns, -1)).reshape(n, rows, right.shape[2])

    def _assembled(self, values: FloatArray, shift: int, columns: int) -> sparse.csr_array:
        """Blocks (n, nonzeros) below each other, each `shift` columns to the right of the one before."""
        (n, count), rows = values.shape, self._shape[0]
        ends = np.cumsum(np.bincount(self._row, minlength=rows))
        start = np.concatenate([[0], (ends + count * np.arange(n)[:, None]).ravel()])
        column = (self._col + shift * np.arange(n)[:, None]).ravel()
        return sparse.csr_array((values.ravel(), column, start), shape=(n * rows, columns))


def equilibrium_change(k: Kernel, matrix: FloatArray, right: FloatArray) -> FloatArray:
    """(..., nx, m) change of the unknowns -matrix^-1 right; matrix: (..., nx, nx) of equilibria.

    LinAlgError where an equilibrium is singular.
    """
    scale = k.scale[:, None]
    try:
        return np.asarray(np.linalg.solve(matrix / scale, -right / scale))
    except np.linalg.LinAlgError:
        raise np.linalg.LinAlgError(SINGULAR_EQUILIBRIUM) from None
