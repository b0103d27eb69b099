"""A CasADi function as a straight-line program: runs of equal operations, each on many values at once.

Carrying out a run costs one branch, so that a program takes two to four times as long as compiled code and a
sixth of the time of CasADi's own interpreter; making one takes a twentieth of the time of compiling.
Reference: P. Bürgisser, M. Clausen, M. A. Shokrollahi, Algebraic Complexity Theory, Springer 1997, chapter 4.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path

import casadi as ca
import numpy as np

from doe_kc.ground.typing import FloatArray, IntArray
from doe_kc.solver.dialect import SCALAR, Dialect
from doe_kc.solver.operations import Operations, operations_of

INTERPRETER = Path(__file__).with_name("program.c")
OFFSET = np.int32(8)
"""Bytes of a number: processors reach a place by this times its number, times 1, 4 or 8 lanes, at no cost."""
PRODUCT_SUM, PRODUCT_DIFFERENCE, DIFFERENCE_FROM = 1000, 1001, 1002
PRODUCT_EXPRESSIONS = {
    PRODUCT_SUM: "a * b + c",
    PRODUCT_DIFFERENCE: "a * b - c",
    DIFFERENCE_FROM: "c - a * b",
}
"""Operations beyond CasADi's: a product that one sum or difference alone reads, with that. Rounded twice, as
the two are: digits stay what they are."""


@dataclass(frozen=True)
class Program:
    """Places hold the arguments, the constants and then values, which share places in turn.

    sizes: numbers of each argument. constants: (k,). runs: (r, 2) operation and how often. operands: (n, 4)
    OFFSET times the places of value and operands a, b, c, one row for each operation. results: (m, 3) result,
    which of its nonzeros, place. patterns: of the results, compressed as CasADi has them, one after the
    other; pattern_starts: where each begins. places: (1,) how many there are.
    """

    sizes: np.ndarray
    constants: FloatArray
    runs: np.ndarray
    operands: np.ndarray
    results: np.ndarray
    patterns: np.ndarray
    pattern_starts: np.ndarray
    places: np.ndarray

    @property
    def length(self) -> int:
        """How many operations one evaluation has."""
        return len(self.operands)

    def pattern(self, result: int) -> ca.Sparsity:
        """Of one result."""
        ends = [*self.pattern_starts[1:], len(self.patterns)]
        return ca.Sparsity.compressed(self.patterns[self.pattern_starts[result] : ends[result]].tolist())


def program_of(function: ca.Function) -> Program:
    """The program of a function; CompileError as `operations_of`."""
    return program_from(operations_of(function))


def program_from(operations: Operations) -> Program:
    """The program of a list of operations."""
    rows, results = _with_products(operations)
    fixed = sum(operations.sizes) + len(operations.constants)
    order, starts = _runs(rows[:, 0], _levels(rows, fixed))
    place, places = _places(rows, results, order, starts, fixed)

    def at(values: IntArray) -> IntArray:
        out = -1 - values
        own = values >= 0
        out[own] = place[values[own]]
        return out

    patterns = [pattern.compress() for pattern in operations.patterns]
    in_order = rows[order]
    return Program(
        sizes=np.array(operations.sizes, dtype=np.int32),
        constants=operations.constants,
        runs=np.column_stack([in_order[starts[:-1], 0], np.diff(starts)]).astype(np.int32),
        operands=OFFSET * np.column_stack([place[order], *map(at, in_order[:, 1:].T)]).astype(np.int32),
        results=np.column_stack([operations.results[:, :2], at(results)]).astype(np.int32),
        patterns=np.array([number for pattern in patterns for number in pattern], dtype=np.int64),
        pattern_starts=np.cumsum([0, *(len(pattern) for pattern in patterns[:-1])]).astype(np.int32),
        places=np.array([places], dtype=np.int32),
    )


def _with_products(operations: Operations) -> tuple[IntArray, IntArray]:
    """(n', 4) operations and operands a, b, c, every product that only one sum or difference reads within
    that, and (m,) operands of the results. c: a where there are but two operands.

    A third of the operations of a Jacobian go, and with them a fifth of its time.
    """
    rows, results = operations.rows, operations.results[:, 2]
    code, a, b = rows.T
    read = np.concatenate([a[a >= 0], b[b >= 0], results[results >= 0]])
    alone = np.flatnonzero((code == ca.OP_MUL) & (np.bincount(read, minlength=len(rows)) == 1))
    sums = np.isin(code, (ca.OP_ADD, ca.OP_SUB))
    first = sums & np.isin(a, alone)
    second = sums & np.isin(b, alone) & ~first
    product = np.where(first, a, b)
    joined = np.column_stack([code, a, b, a])
    for taken, other, names in (
        (first, b, {ca.OP_ADD: PRODUCT_SUM, ca.OP_SUB: PRODUCT_DIFFERENCE}),
        (second, a, {ca.OP_ADD: PRODUCT_SUM, ca.OP_SUB: DIFFERENCE_FROM}),
    ):
        joined[taken, 1:3] = rows[product[taken], 1:]
        joined[taken, 3] = other[taken]
        for plain, with_product in names.items():
            joined[taken & (code == plain), 0] = with_product
    kept = np.ones(len(rows), dtype=bool)
    kept[product[first | second]] = False
    number = np.cumsum(kept) - 1

    def renumbered(values: IntArray) -> IntArray:
        out, own = values.copy(), values >= 0
        out[own] = number[values[own]]
        return out

    joined[:, 1:] = renumbered(joined[:, 1:])
    return joined[kept], renumbered(results)


def _levels(rows: IntArray, first: int) -> IntArray:
    """(n,) how many operations must come before each one, one after the other. first: how many arguments and
    constants there are."""
    count = len(rows)
    levels = [-1] * (count + first)  # arguments and constants from behind
    for k, (_, a, b, c) in enumerate(rows.tolist()):
        levels[k] = 1 + max(levels[a], levels[b], levels[c])
    return np.array(levels[:count], dtype=np.int64)


def _runs(code: IntArray, level: IntArray) -> tuple[IntArray, IntArray]:
    """An order of the operations (n,) in which the operands of a run of one operation come before it, and
    where each run begins there, then the end."""
    order = np.lexsort((code, level))
    new = (np.diff(code[order]) != 0) | (np.diff(level[order]) != 0)
    return order, np.unique(np.concatenate([[0], np.flatnonzero(new) + 1, [len(order)]]))


def _places(
    operations: IntArray, results: IntArray, order: IntArray, starts: IntArray, fixed: int
) -> tuple[IntArray, int]:
    """Place of every value, free again after the run that reads it last, and how many places there are.

    fixed: places of arguments and constants, before them. results: (m,) operands that are read at the end.
    """
    count, runs = len(operations), len(starts) - 1
    run = np.empty(count, dtype=np.int64)
    run[order] = np.repeat(np.arange(runs), np.diff(starts))
    last = run.copy()
    for operand in operations[:, 1:].T:
        np.maximum.at(last, operand[operand >= 0], run[operand >= 0])
    last[results[results >= 0]] = runs
    leaving = _by_run(last, runs)
    place, free, places = np.empty(count, dtype=np.int64), np.empty(0, dtype=np.int64), fixed
    for k in range(runs):
        own = order[starts[k] : starts[k + 1]]
        again = min(len(free), len(own))
        split = len(free) - again
        place[own[:again]] = free[split:]
        place[own[again:]] = np.arange(places, places + len(own) - again)
        places += len(own) - again
        free = np.concatenate([free[:split], place[leaving[k]]])
    return place, places


def _by_run(last: IntArray, runs: int) -> list[IntArray]:
    """Values by the run that reads them last."""
    order = np.argsort(last, kind="stable")
    return np.split(order, np.searchsorted(last[order], np.arange(1, runs + 1)))


def interpreter_source(dialect: Dialect = SCALAR) -> str:
    """C of program.c for the numbers of a dialect."""
    texts = {code: text.format("a", "b") for code, text in dialect.expressions.items()} | PRODUCT_EXPRESSIONS
    lines = [f"OPERATION({code}, {text})" for code, text in texts.items()]
    macros = f"#define NUMBER {dialect.number}\n#define OPERATIONS " + " \\\n".join(lines)
    return f"{dialect.before}\n{macros}\n{INTERPRETER.read_text()}"


def programs_bytes(programs: Mapping[str, Program]) -> bytes:
    """An archive of arrays."""
    file = io.BytesIO()
    np.savez(
        file,
        allow_pickle=False,
        **{f"{name}.{f.name}": getattr(p, f.name) for name, p in programs.items() for f in fields(Program)},
    )
    return file.getvalue()


def read_programs(content: bytes) -> dict[str, Program]:
    """Of `programs_bytes`; ValueError for anything else."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:
            names = dict.fromkeys(key.partition(".")[0] for key in archive.files)
            return {
                name: Program(**{f.name: archive[f"{name}.{f.name}"] for f in fields(Program)})
                for name in names
            }
    except (zipfile.BadZipFile, KeyError, EOFError, OSError) as error:
        raise ValueError("no programs") from error
