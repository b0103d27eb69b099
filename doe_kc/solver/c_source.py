"""C of a CasADi function, in pieces that a compiler optimizes in time proportional to their number.

CasADi's own generator writes one function of some ten thousand statements, for which a compiler takes four
times as long at -O1 as for the same statements in pieces of 300; at -O0 they run five times slower.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import casadi as ca

from doe_kc.solver.dialect import SCALAR, Dialect
from doe_kc.solver.operations import Operations, operations_of

PIECE = 300
"""Statements a piece: from 200 to 500 neither compiling nor running changes by more than a tenth."""
PIECES_A_FILE = 40
"""Files are compiled side by side."""
PIECE_ATTRIBUTES = '__attribute__((noinline, visibility("hidden")))'


@dataclass(frozen=True)
class _Statement:
    """A value, or an output where `target` names one, from operands: C text, or the value's number."""

    expression: str
    operands: tuple[str | int, ...]
    target: str = ""


def c_sources(
    function: ca.Function, dialect: Dialect = SCALAR, operations: Operations | None = None
) -> dict[str, str]:
    """C sources by file name of a function of dense or sparse arguments, nonzeros column by column.

    Scalar ones are of the interface that `casadi.external` loads. operations: by which its results are
    computed, None for its own. CompileError as `operations_of`.
    """
    own = operations_of(function) if operations is None else operations
    texts, room = _piece_texts(_pieces(_statements(own, dialect)), dialect)
    number, name = dialect.number, function.name()
    inputs, outputs = range(function.n_in()), range(function.n_out())
    parameters = [
        *(f"const {number} *x{i}" for i in inputs),
        *(f"{number} *restrict y{i}" for i in outputs),
        f"{number} *restrict w",
    ]
    arguments = [*(f"arg[{i}]" for i in inputs), *(f"res[{i}]" for i in outputs), "w"]
    heads = [f"{PIECE_ATTRIBUTES} void {name}_{i}({', '.join(parameters)})" for i in range(len(texts))]
    entry = [
        dialect.before,
        *(f"{head};" for head in heads),
        _casadi_interface(function),
        f"int {name}(const {number} **arg, {number} **res, long long *iw, {number} *memory, int instance) {{",
        f"{number} w[{max(1, room)}];",
        *(f"{name}_{i}({', '.join(arguments)});" for i in range(len(texts))),
        "return 0;",
        "}",
    ]
    files = {name: entry}
    for first in range(0, len(texts), PIECES_A_FILE):
        file = files.setdefault(f"{name}_{first}", [dialect.before])
        for head, text in list(zip(heads, texts, strict=True))[first : first + PIECES_A_FILE]:
            file += [f"{head} {{", *text, "}"]
    return {part: "\n".join(lines) + "\n" for part, lines in files.items()}


def _statements(operations: Operations, dialect: Dialect) -> dict[int, _Statement]:
    """By number, in order, results behind; arguments and constants stand in the operands."""
    arguments = [f"x{i}[{k}]" for i, size in enumerate(operations.sizes) for k in range(size)]
    known = arguments + [dialect.literal.format(_literal(value)) for value in operations.constants.tolist()]

    def operand(number: int) -> str | int:
        return number if number >= 0 else known[-1 - number]

    out = {
        k: _Statement(dialect.expressions[code], (operand(a), operand(b)))
        for k, (code, a, b) in enumerate(operations.rows.tolist())
    }
    for k, (result, place, value) in enumerate(operations.results.tolist(), start=len(out)):
        out[k] = _Statement("{0}", (operand(value),), f"y{result}[{place}]")
    return out


def _literal(value: float) -> str:
    """A double in C, in parentheses."""
    if value != value:
        return "NAN"
    return f"({value!r})" if abs(value) < float("inf") else "INFINITY" if value > 0.0 else "(-INFINITY)"


def _pieces(statements: dict[int, _Statement]) -> list[list[tuple[int, _Statement]]]:
    items = list(statements.items())
    return [items[i : i + PIECE] for i in range(0, len(items), PIECE)]


def _piece_texts(pieces: list[list[tuple[int, _Statement]]], dialect: Dialect) -> tuple[list[list[str]], int]:
    """Lines of each piece, and how many places values need that later pieces read."""
    piece_of = {k: i for i, piece in enumerate(pieces) for k, _ in piece}
    last = dict(piece_of)  # piece that reads a value last
    for i, piece in enumerate(pieces):
        for _, statement in piece:
            last |= {v: i for v in statement.operands if isinstance(v, int)}
    place: dict[int, int] = {}
    free, leaving = list[int](), defaultdict[int, list[int]](list)
    room, texts = 0, []
    for i, piece in enumerate(pieces):
        free += leaving.pop(i - 1, [])
        lines = []
        for k, statement in piece:
            terms = [
                v if isinstance(v, str) else f"v{v}" if piece_of[v] == i else f"w[{place[v]}]"
                for v in statement.operands
            ]
            value = statement.expression.format(*terms)
            if statement.target:
                lines.append(f"{statement.target} = {value};")
                continue
            lines.append(f"const {dialect.number} v{k} = {value};")
            if last[k] > i:
                place[k] = free.pop() if free else room
                room = max(room, place[k] + 1)
                leaving[last[k]].append(place[k])
                lines.append(f"w[{place[k]}] = v{k};")
        texts.append(lines)
    return texts, room


def _casadi_interface(function: ca.Function) -> str:
    """Sizes and patterns of arguments and results, as `casadi.external` asks for them."""
    name = function.name()
    lines = []
    for way, count, pattern in (
        ("in", function.n_in(), function.sparsity_in),
        ("out", function.n_out(), function.sparsity_out),
    ):
        lines.append(f"long long {name}_n_{way}(void) {{ return {count}; }}")
        for i in range(count):
            numbers = ", ".join(map(str, pattern(i).compress()))
            lines.append(f"static const long long {way}_{i}[] = {{{numbers}}};")
        cases = " ".join(f"case {i}: return {way}_{i};" for i in range(count))
        lines.append(
            f"const long long *{name}_sparsity_{way}(long long i) {{ switch (i) {{ {cases} }} return 0; }}"
        )
    sizes = f"*arg = {function.n_in()}; *res = {function.n_out()}; *iw = 0; *w = 0; return 0;"
    lines.append(
        f"int {name}_work(long long *arg, long long *res, long long *iw, long long *w) {{ {sizes} }}"
    )
    return "\n".join(lines)
