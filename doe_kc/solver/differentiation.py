"""Derivatives of a list of operations, as one that shares what they have in common.

Every operation is a vertex of a graph whose edges are its partial derivatives to its operands; a vertex goes
by multiplying those into it with those out of it, the one with the fewest products first (Markowitz), until
only arguments and results are left. CasADi's derivatives of an axle, column by column, have a fifth to a half
more operations, and take three times as long to make and to read.
Reference: A. Griewank, A. Walther, Evaluating Derivatives, 2nd edition, SIAM, 2008, chapters 9 and 10.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from functools import cache

import casadi as ca
import numpy as np

from doe_kc.solver.dialect import EXPRESSIONS
from doe_kc.solver.operations import Operations, Recorder, operations_of

BINARY = frozenset(code for code, text in EXPRESSIONS.items() if "{1}" in text)
Edges = list[dict[int, int]]
"""By vertex, its predecessors and the operand of the partial derivative to each."""


def derivatives(operations: Operations, blocks: Sequence[tuple[int, int]]) -> Operations:
    """Of dense results to arguments: blocks of result and argument by number, column by column.

    What depends on an argument only by way of comparisons, signs and the like has no derivative to it.
    """
    ends = np.cumsum(operations.sizes).tolist()
    wanted = {argument for _, argument in blocks}
    moving = {-1 - i for a in wanted for i in range(ends[a] - operations.sizes[a], ends[a])}
    recorder = _Derivation(operations)
    rows = [tuple(row) for row in operations.results.tolist()]
    edges = _partials(operations, recorder, moving, [operand for _, _, operand in rows])
    _eliminate(edges, len(operations.rows), recorder)
    by_row = {(result, row): edges[len(operations.rows) + k] for k, (result, row, _) in enumerate(rows)}
    results: list[tuple[int, int, int]] = []
    patterns: list[ca.Sparsity] = []
    for block, (result, argument) in enumerate(blocks):
        height, width = operations.patterns[result].shape[0], operations.sizes[argument]
        first = ends[argument] - width
        entries = sorted(
            (-1 - at - first, row, value)
            for row in range(height)
            for at, value in by_row.get((result, row), {}).items()
            if first <= -1 - at < first + width
        )
        starts = np.cumsum(np.bincount([column for column, _, _ in entries], minlength=width)).tolist()
        patterns.append(ca.Sparsity(height, width, [0, *starts], [row for _, row, _ in entries]))
        results += [(block, k, value) for k, (_, _, value) in enumerate(entries)]
    return _without_unused(recorder.finished(operations.sizes, results, patterns))


class _Derivation(Recorder):
    """Products and sums of partial derivatives behind the operations that they are of."""

    def __init__(self, operations: Operations) -> None:
        super().__init__(sum(operations.sizes))
        self.constants = operations.constants.tolist()
        self.operations = {(code, a, b): k for k, (code, a, b) in enumerate(operations.rows.tolist())}
        self._lowest = self._first
        self._by_value: dict[float, int] = {}
        self.one = self.constant(1.0)

    def constant(self, value: float) -> int:
        """The same for the same value."""
        if value not in self._by_value:
            self._by_value[value] = super().constant(value)
        return self._by_value[value]

    def value(self, operand: int) -> float | None:
        """Of a constant, None of anything else."""
        return self.constants[self._lowest - operand] if operand <= self._lowest else None

    def product(self, a: int, b: int) -> int:
        """Operand of a times b."""
        if a > self._lowest and b > self._lowest:  # no constant, as nearly always
            return self.operation(ca.OP_MUL, a, b)
        known, other = self.value(a), self.value(b)
        if known is not None and other is not None:
            return self.constant(known * other)
        for factor, left in ((known, b), (other, a)):
            if factor == 1.0:
                return left
            if factor == -1.0:
                return self.operation(ca.OP_NEG, left, left)
        return self.operation(ca.OP_MUL, a, b)

    def total(self, a: int, b: int) -> int:
        """Operand of a plus b."""
        if a > self._lowest or b > self._lowest:
            return self.operation(ca.OP_ADD, a, b)
        known, other = self.value(a), self.value(b)
        assert known is not None and other is not None
        return self.constant(known + other)


def _partials(
    operations: Operations, recorder: _Derivation, moving: set[int], results: Sequence[int]
) -> Edges:
    """Edges of every operation that is needed and moves, then those of the results, each of one operand.

    moving: operands of the arguments.
    """
    rows = operations.rows.tolist()
    needed = _needed(rows, results)
    edges: Edges = [{} for _ in range(len(rows) + len(results))]
    for k, (code, a, b) in enumerate(rows):
        if not needed[k] or not (a in moving or b in moving):
            continue
        by_operand = zip(dict.fromkeys((a, b)), _of_operation(code, recorder, a, b), strict=False)
        edges[k] = {at: value for at, value in by_operand if at in moving and value is not None}
        if edges[k]:
            moving.add(k)
    for k, operand in enumerate(results, start=len(rows)):
        if operand in moving:
            edges[k] = {operand: recorder.one}
    return edges


def _of_operation(code: int, recorder: _Derivation, a: int, b: int) -> tuple[int | None, int | None]:
    """Operands of the derivatives to a and b, None where there is none; to a alone where both are one."""
    constants, rows, results = _template(code, alone=a == b)
    at = {-1: a, -2: b}
    for k, value in enumerate(constants, start=2 if a == b else 3):
        at[-k] = recorder.constant(value)
    for k, (own, x, y) in enumerate(rows):
        at[k] = recorder.operation(own, at[x], at[y])
    there = {result: at[operand] for result, _, operand in results}
    return there.get(0), there.get(1)


@cache
def _template(code: int, *, alone: bool) -> tuple[list[float], list[list[int]], list[list[int]]]:
    """Constants, rows and results of CasADi's derivatives of an operation to each of its operands.

    alone: of one operand, or twice the same.
    """
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    symbols = [x] if alone else [x, y]
    if code == ca.OP_ASSIGN:
        value = x
    elif alone and code not in BINARY:
        value = ca.SX.unary(code, x)
    else:
        value = ca.SX.binary(code, x, x if alone else y)
    out = operations_of(ca.Function("partials", symbols, [ca.jacobian(value, s) for s in symbols]))
    return out.constants.tolist(), out.rows.tolist(), out.results.tolist()


def _eliminate(edges: Edges, count: int, recorder: _Derivation) -> None:
    """Leave edges from arguments to results alone: the first `count` vertices go, of equal ones the last."""
    following: dict[int, set[int]] = {}
    for k, before in enumerate(edges):
        for at in before:
            following.setdefault(at, set()).add(k)

    def products(k: int) -> int:
        return len(edges[k]) * len(following.get(k, ()))

    least = [products(k) for k in range(count)]  # in the queue: a vertex has no fewer products than that
    queue = [(size, -k) for k, size in enumerate(least)]
    heapq.heapify(queue)
    left = [True] * count
    while queue:
        size, last = heapq.heappop(queue)
        k = -last
        if not left[k] or size > least[k]:
            continue
        if (now := products(k)) > size:
            least[k] = now
            heapq.heappush(queue, (now, last))
            continue
        left[k] = False
        before, after = edges[k], following.pop(k, set())
        for at in before:
            following[at].discard(k)
        for to in sorted(after):
            own = edges[to]
            outer = own.pop(k)
            for at, inner in before.items():
                value = recorder.product(outer, inner)
                own[at] = recorder.total(own[at], value) if at in own else value
                following[at].add(to)
        edges[k] = {}
        for near in (*before, *after):
            if 0 <= near < count and left[near] and (now := products(near)) < least[near]:
                least[near] = now
                heapq.heappush(queue, (now, -near))


def _needed(rows: Sequence[Sequence[int]], results: Sequence[int]) -> list[bool]:
    """Of each operation, whether one of the operands `results` hangs on it."""
    needed = [False] * len(rows)
    for operand in results:
        if operand >= 0:
            needed[operand] = True
    for k in range(len(rows) - 1, -1, -1):
        if needed[k]:
            for operand in rows[k][1:]:
                if operand >= 0:
                    needed[operand] = True
    return needed


def _without_unused(all_of: Operations) -> Operations:
    """Without operations that no result needs."""
    kept = np.array(_needed(all_of.rows.tolist(), all_of.results[:, 2].tolist()), dtype=bool)
    number = np.append(np.cumsum(kept) - 1, 0)

    def renumbered(operands: np.ndarray) -> np.ndarray:
        return np.where(operands >= 0, number[operands], operands)

    rows_kept, results = all_of.rows[kept], all_of.results
    rows_kept[:, 1:] = renumbered(rows_kept[:, 1:])
    results = np.column_stack([results[:, :2], renumbered(results[:, 2])])
    return Operations(all_of.sizes, all_of.constants, rows_kept, results, all_of.patterns)
