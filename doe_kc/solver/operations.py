"""A CasADi function as a list of operations, no value computed twice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np

from doe_kc.ground.typing import FloatArray, IntArray
from doe_kc.solver.dialect import EXPRESSIONS
from doe_kc.solver.library import CompileError

COMMUTATIVE = frozenset({ca.OP_ADD, ca.OP_MUL})
Operation = tuple[int, int, int]
"""CasADi's number and two operands, the same one twice where there is but one."""


@dataclass(frozen=True)
class Operations:
    """Operands are numbered from 0 on by the operation whose value they are, and from -1 downwards by the
    numbers of all arguments, then the constants.

    sizes: numbers of each argument. constants: (k,). rows: (n, 3), one `Operation` each. results: (m, 3)
    result, which of its nonzeros, operand. patterns: of the results.
    """

    sizes: tuple[int, ...]
    constants: FloatArray
    rows: IntArray
    results: IntArray
    patterns: tuple[ca.Sparsity, ...]


class Recorder:
    """Collects operations and constants, none of them twice. arguments: how many numbers those have."""

    def __init__(self, arguments: int) -> None:
        self.operations: dict[Operation, int] = {}
        """By operation its value's operand."""
        self.constants: list[float] = []
        self._first = -1 - arguments

    def operation(self, code: int, a: int, b: int) -> int:
        """Operand of its value. b: a for an operation of one operand."""
        key = (code, b, a) if b < a and code in COMMUTATIVE else (code, a, b)
        return self.operations.setdefault(key, len(self.operations))

    def constant(self, value: float) -> int:
        """Operand of a constant."""
        self.constants.append(value)
        return self._first + 1 - len(self.constants)

    def finished(
        self, sizes: Sequence[int], results: Sequence[tuple[int, int, int]], patterns: Sequence[ca.Sparsity]
    ) -> Operations:
        """What was collected, with its results."""
        return Operations(
            tuple(sizes),
            np.array(self.constants, dtype=float),
            np.array(list(self.operations), dtype=np.int64).reshape(-1, 3),
            np.array(results, dtype=np.int64).reshape(-1, 3),
            tuple(patterns),
        )


def operations_of(function: ca.Function) -> Operations:
    """Of a function; CompileError for an operation that `c_source.EXPRESSIONS` lacks."""
    sizes = [function.nnz_in(i) for i in range(function.n_in())]
    starts = np.cumsum([0, *sizes]).tolist()
    held: dict[int, int] = {}  # what CasADi's memory holds at each place
    recorder = Recorder(starts[-1])
    results: list[tuple[int, int, int]] = []
    for k in range(function.n_instructions()):
        code, to = function.instruction_id(k), function.instruction_output(k)
        if code == ca.OP_CONST:
            held[to[0]] = recorder.constant(function.instruction_constant(k))
            continue
        operands = function.instruction_input(k)
        if code == ca.OP_INPUT:
            held[to[0]] = -1 - starts[operands[0]] - operands[1]
        elif code == ca.OP_OUTPUT:
            results.append((to[0], to[1], held[operands[0]]))
        elif code in EXPRESSIONS:
            held[to[0]] = recorder.operation(code, held[operands[0]], held[operands[-1]])
        else:
            raise CompileError(f"operation {code} of {function.name()} has no C expression in EXPRESSIONS")
    patterns = [function.sparsity_out(i) for i in range(function.n_out())]
    return recorder.finished(sizes, results, patterns)
