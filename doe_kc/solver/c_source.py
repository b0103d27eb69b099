"""C of a CasADi function, in pieces that a compiler optimizes in time proportional to their number.

CasADi's own generator writes one function of some ten thousand statements, for which a compiler takes four
times as long at -O1 as for the same statements in pieces of 300; at -O0 they run five times slower.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

from doe_kc.solver.library import CompileError

PIECE = 300
"""Statements a piece: from 200 to 500 neither compiling nor running changes by more than a tenth."""
PIECES_A_FILE = 40
"""Files are compiled side by side."""
PIECE_ATTRIBUTES = '__attribute__((noinline, visibility("hidden")))'
EXPRESSIONS = {
    ca.OP_ASSIGN: "{0}",
    ca.OP_ADD: "{0} + {1}",
    ca.OP_SUB: "{0} - {1}",
    ca.OP_MUL: "{0} * {1}",
    ca.OP_DIV: "{0} / {1}",
    ca.OP_NEG: "-{0}",
    ca.OP_SQ: "{0} * {0}",
    ca.OP_TWICE: "{0} + {0}",
    ca.OP_INV: "1.0 / {0}",
    ca.OP_LT: "{0} < {1}",
    ca.OP_LE: "{0} <= {1}",
    ca.OP_EQ: "{0} == {1}",
    ca.OP_NE: "{0} != {1}",
    ca.OP_AND: "{0} && {1}",
    ca.OP_OR: "{0} || {1}",
    ca.OP_NOT: "!{0}",
    ca.OP_IF_ELSE_ZERO: "{0} ? {1} : 0.0",
    ca.OP_SQRT: "sqrt({0})",
    ca.OP_EXP: "exp({0})",
    ca.OP_LOG: "log({0})",
    ca.OP_SIN: "sin({0})",
    ca.OP_COS: "cos({0})",
    ca.OP_TAN: "tan({0})",
    ca.OP_ASIN: "asin({0})",
    ca.OP_ACOS: "acos({0})",
    ca.OP_ATAN: "atan({0})",
    ca.OP_SINH: "sinh({0})",
    ca.OP_COSH: "cosh({0})",
    ca.OP_TANH: "tanh({0})",
    ca.OP_ASINH: "asinh({0})",
    ca.OP_ACOSH: "acosh({0})",
    ca.OP_ATANH: "atanh({0})",
    ca.OP_LOG1P: "log1p({0})",
    ca.OP_EXPM1: "expm1({0})",
    ca.OP_HYPOT: "hypot({0}, {1})",
    ca.OP_REMAINDER: "remainder({0}, {1})",
    ca.OP_FABS: "fabs({0})",
    ca.OP_SIGN: "{0} < 0.0 ? -1.0 : {0} > 0.0 ? 1.0 : {0}",
    ca.OP_FLOOR: "floor({0})",
    ca.OP_CEIL: "ceil({0})",
    ca.OP_ERF: "erf({0})",
    ca.OP_POW: "pow({0}, {1})",
    ca.OP_CONSTPOW: "pow({0}, {1})",
    ca.OP_ATAN2: "atan2({0}, {1})",
    ca.OP_FMIN: "fmin({0}, {1})",
    ca.OP_FMAX: "fmax({0}, {1})",
    ca.OP_COPYSIGN: "copysign({0}, {1})",
    ca.OP_FMOD: "fmod({0}, {1})",
}
"""C of each operation of CasADi's, by its operands."""
CALL = re.compile(r"\b(?=[a-z0-9]+\()")
LANE_EXPRESSIONS = {
    **{code: CALL.sub("lane_", text) for code, text in EXPRESSIONS.items()},
    **{code: f"lane_truth({EXPRESSIONS[code]})" for code in (ca.OP_LT, ca.OP_LE, ca.OP_EQ, ca.OP_NE)},
    ca.OP_AND: "lane_truth(({0} != 0.0) & ({1} != 0.0))",
    ca.OP_OR: "lane_truth(({0} != 0.0) | ({1} != 0.0))",
    ca.OP_NOT: "lane_truth({0} == 0.0)",
    ca.OP_IF_ELSE_ZERO: "lane_where({0} != 0.0, {1})",
    ca.OP_SIGN: "lane_sign({0})",
}
"""The same for several designs side by side, by the functions of lanes.h."""


@dataclass(frozen=True)
class Dialect:
    """How values are written. number: their C type; literal: of a constant, from the C of a double;
    expressions: by operation; before: text at the head of every file."""

    number: str
    literal: str
    expressions: Mapping[int, str]
    before: str


SCALAR = Dialect("double", "{0}", EXPRESSIONS, "#include <math.h>")


@dataclass(frozen=True)
class _Statement:
    """A value, or an output where `target` names one, from operands: C text, or the value's number."""

    expression: str
    operands: tuple[str | int, ...]
    target: str = ""


def c_sources(function: ca.Function, dialect: Dialect = SCALAR) -> dict[str, str]:
    """C sources by file name of a function of dense or sparse arguments, nonzeros column by column.

    Scalar ones are of the interface that `casadi.external` loads. CompileError for an operation that
    `EXPRESSIONS` lacks.
    """
    texts, room = _piece_texts(_pieces(_statements(function, dialect)), dialect)
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


def _statements(function: ca.Function, dialect: Dialect) -> dict[int, _Statement]:
    """By number, in order; inputs and constants stand in the operands."""
    values: dict[int, str | int] = {}  # what CasADi's memory holds at each place
    out: dict[int, _Statement] = {}
    for k in range(function.n_instructions()):
        code = function.instruction_id(k)
        places = function.instruction_output(k)
        if code == ca.OP_CONST:
            values[places[0]] = dialect.literal.format(_literal(function.instruction_constant(k)))
            continue
        operands = function.instruction_input(k)
        if code == ca.OP_INPUT:
            values[places[0]] = f"x{operands[0]}[{operands[1]}]"
        elif code == ca.OP_OUTPUT:
            out[k] = _Statement("{0}", (values[operands[0]],), f"y{places[0]}[{places[1]}]")
        elif code in dialect.expressions:
            out[k] = _Statement(dialect.expressions[code], tuple(values[i] for i in operands))
            values[places[0]] = k
        else:
            raise CompileError(f"operation {code} of {function.name()} has no C expression in EXPRESSIONS")
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
