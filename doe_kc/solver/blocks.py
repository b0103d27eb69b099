"""Derivative blocks of one topology's equations: symbolic once, in numbers at every equilibrium."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import casadi as ca
import numpy as np
from scipy import sparse
from scipy.linalg import lapack

from doe_kc.solver.kernel import Buffered, Kernel, kernel
from doe_kc.solver.topology import KEPT, Topology
from doe_kc.typing import FloatArray


@lru_cache(maxsize=KEPT)
def blocks(topology: Topology) -> Mapping[str, ca.Function]:
    """Derivative functions by block name: R_x is d(residual)/dx, Y_c d(outputs)/dc, and so on."""
    k = kernel(topology)
    eq = k.equations
    symbols = [eq.x, eq.c, eq.u, eq.z]
    parts = {"R": eq.residual, "Y": eq.outputs} | ({"Z": eq.next_state} if k.nz else {})
    by = {"x": eq.x, "c": eq.c, "u": eq.u} | ({"z": eq.z} if k.nz else {})
    out = {
        f"{part}_{name}": ca.Function(f"{part}_{name}_block", symbols, [ca.jacobian(expression, symbol)])
        for part, expression in parts.items()
        for name, symbol in by.items()
        if (part, name) != ("R", "x")
    }
    out["R_x"] = k.functions["jacobian"]
    out["constants"] = ca.Function("constants_block", [eq.p], [ca.jacobian(eq.constants, eq.p)])
    return out


class Block:
    """A sparse derivative block evaluated through buffers."""

    def __init__(self, function: ca.Function) -> None:
        pattern = function.sparsity_out(0)
        self._evaluate = Buffered(function)
        row, col = pattern.get_triplet()
        self._row, self._col = np.array(row, dtype=int), np.array(col, dtype=int)
        self._shape = pattern.shape

    def __call__(self, *arguments: FloatArray) -> FloatArray:
        """The dense block at one point."""
        out = np.zeros(self._shape, order="F")
        out[self._row, self._col] = self._evaluate(*arguments)
        return out

    def times(self, points: Sequence[tuple[FloatArray, ...]], right: sparse.csr_array) -> FloatArray:
        """(n, rows, columns) products of the blocks at many points with one sparse matrix, dense."""
        n, rows = len(points), self._shape[0]
        values = np.array([self._evaluate(*at).copy() for at in points]).reshape(n, -1)
        row = (self._row + rows * np.arange(n)[:, None]).ravel()
        stacked = sparse.csr_array(
            (values.ravel(), (row, np.tile(self._col, n))), shape=(n * rows, self._shape[1])
        )
        return np.asarray((stacked @ right).toarray()).reshape(n, rows, right.shape[1])


def equilibrium_change(k: Kernel, matrix: FloatArray, right: FloatArray) -> FloatArray:
    """(nx, m) change of the unknowns -matrix^-1 right; matrix: (nx, nx) of an equilibrium, right: (nx, m).

    LinAlgError where the equilibrium is singular.
    """
    scale = k.scale[:, None]
    _, _, solved, info = lapack.dgesv(matrix / scale, -right / scale, overwrite_a=True, overwrite_b=True)
    if info:
        raise np.linalg.LinAlgError("singular equilibrium: no sensitivity exists")
    return np.asarray(solved)
