"""A CasADi function as a straight-line program: runs of equal operations, each on many values at once.

Carrying out a run costs one branch, so that a program takes about four times as long as compiled code and a
sixth of the time of CasADi's own interpreter; making one takes a twentieth of the time of compiling.
Reference: P. Bürgisser, M. Clausen, M. A. Shokrollahi, Algebraic Complexity Theory, Springer 1997, chapter 4.
"""

from __future__ import annotations

import io
import zipfile
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, fields
from itertools import pairwise
from pathlib import Path

import casadi as ca
import numpy as np

from doe_kc.ground.typing import FloatArray
from doe_kc.solver.c_source import EXPRESSIONS, SCALAR, Dialect
from doe_kc.solver.library import CompileError

INTERPRETER = Path(__file__).with_name("program.c")
COMMUTATIVE = frozenset({ca.OP_ADD, ca.OP_MUL})
_Operation = tuple[int, int, int]
"""CasADi's number, and two operands: from 0 on that operation's value, below it an argument or constant."""


@dataclass(frozen=True)
class Program:
    """Places hold the arguments, the constants and then values, which share places in turn.

    sizes: numbers of each argument. constants: (k,). runs: (r, 2) operation and how often. operands: (n, 3)
    places of value and operands, one row for each operation. results: (m, 3) result, which of its nonzeros,
    place. patterns: of the results, compressed as CasADi has them, one after the other; pattern_starts: where
    each begins. places: (1,) how many there are.
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
    """The program of a function; CompileError for an operation that `c_source.EXPRESSIONS` lacks."""
    sizes = [function.nnz_in(i) for i in range(function.n_in())]
    operations, constants, results = _operations(function, sizes)
    runs, order = _runs(operations)
    fixed = sum(sizes) + len(constants)
    place, places = _places(operations, results, runs, order, fixed)

    def at(value: int) -> int:
        return place[value] if value >= 0 else -1 - value

    patterns = [function.sparsity_out(i).compress() for i in range(function.n_out())]
    return Program(
        sizes=np.array(sizes, dtype=np.int32),
        constants=np.array(constants, dtype=float),
        runs=np.array(runs, dtype=np.int32).reshape(-1, 2),
        operands=np.array(
            [(place[i], at(operations[i][1]), at(operations[i][2])) for i in order], dtype=np.int32
        ).reshape(-1, 3),
        results=np.array([(r, k, at(value)) for r, k, value in results], dtype=np.int32).reshape(-1, 3),
        patterns=np.array([number for pattern in patterns for number in pattern], dtype=np.int64),
        pattern_starts=np.cumsum([0, *(len(pattern) for pattern in patterns[:-1])]).astype(np.int32),
        places=np.array([places], dtype=np.int32),
    )


def _operations(
    function: ca.Function, sizes: list[int]
) -> tuple[list[_Operation], list[float], list[tuple[int, int, int]]]:
    """Operations, none of them twice, constants, and results: (result, nonzero, operand)."""
    starts = np.cumsum([0, *sizes]).tolist()
    held: dict[int, int] = {}  # what CasADi's memory holds at each place
    operations: list[_Operation] = []
    number: dict[_Operation, int] = {}
    constants: list[float] = []
    results = []
    for k in range(function.n_instructions()):
        code, to = function.instruction_id(k), function.instruction_output(k)
        if code == ca.OP_CONST:
            held[to[0]] = -1 - starts[-1] - len(constants)
            constants.append(function.instruction_constant(k))
            continue
        operands = function.instruction_input(k)
        if code == ca.OP_INPUT:
            held[to[0]] = -1 - starts[operands[0]] - operands[1]
        elif code == ca.OP_OUTPUT:
            results.append((to[0], to[1], held[operands[0]]))
        elif code in EXPRESSIONS:
            a, b = held[operands[0]], held[operands[-1]]
            operation = (code, b, a) if code in COMMUTATIVE and b < a else (code, a, b)
            if operation not in number:
                number[operation] = len(operations)
                operations.append(operation)
            held[to[0]] = number[operation]
        else:
            raise CompileError(f"operation {code} of {function.name()} has no C expression in EXPRESSIONS")
    return operations, constants, results


def _runs(operations: list[_Operation]) -> tuple[list[tuple[int, int]], list[int]]:
    """Runs of one operation whose operands are known, the longest one first, and the order that follows."""
    readers: list[list[int]] = [[] for _ in operations]
    missing = []
    ready = defaultdict[int, list[int]](list)
    for i, (code, a, b) in enumerate(operations):
        needed = {v for v in (a, b) if v >= 0}
        missing.append(len(needed))
        for value in needed:
            readers[value].append(i)
        if not needed:
            ready[code].append(i)
    runs, order = [], list[int]()
    while ready:
        code = max(ready, key=lambda c: len(ready[c]))
        run = ready.pop(code)
        runs.append((code, len(run)))
        order += run
        for i in run:
            for reader in readers[i]:
                missing[reader] -= 1
                if not missing[reader]:
                    ready[operations[reader][0]].append(reader)
    return runs, order


def _places(
    operations: list[_Operation],
    results: list[tuple[int, int, int]],
    runs: list[tuple[int, int]],
    order: list[int],
    fixed: int,
) -> tuple[list[int], int]:
    """Place of every value, free again after the run that reads it last, and how many places there are."""
    run_of, last = [0] * len(operations), [0] * len(operations)
    starts = np.cumsum([0, *(count for _, count in runs)]).tolist()
    for run, (start, end) in enumerate(pairwise(starts)):
        for i in order[start:end]:
            run_of[i] = last[i] = run
            for value in operations[i][1:]:
                if value >= 0:
                    last[value] = run
    for _, _, value in results:
        if value >= 0:
            last[value] = len(runs)
    leaving = defaultdict[int, list[int]](list)
    free, place, places = list[int](), [0] * len(operations), fixed
    for run, (start, end) in enumerate(pairwise(starts)):
        for i in order[start:end]:
            if free:
                place[i] = free.pop()
            else:
                place[i] = places
                places += 1
            leaving[last[i]].append(place[i])
        free += leaving.pop(run, [])
    return place, places


def interpreter_source(dialect: Dialect = SCALAR) -> str:
    """C of program.c for the numbers of a dialect."""
    lines = [f"OPERATION({code}, {text.format('a', 'b')})" for code, text in dialect.expressions.items()]
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
