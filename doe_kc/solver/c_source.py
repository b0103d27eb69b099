"""C of a CasADi function, in pieces that a compiler optimizes in time proportional to their number.

CasADi's own generator writes one function of some ten thousand statements, for which a compiler takes four
times as long at -O1 as for the same statements in pieces of 300; at -O0 they run five times slower.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import casadi as ca

PIECE = 300
"""Statements a piece: from 200 to 500 neither compiling nor running changes by more than a tenth."""
LANES_HEADER = Path(__file__).with_name("lanes.h")
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
    ca.OP_LT: "less({0}, {1})",
    ca.OP_LE: "at_most({0}, {1})",
    ca.OP_EQ: "equal({0}, {1})",
    ca.OP_NE: "unequal({0}, {1})",
    ca.OP_AND: "both({0}, {1})",
    ca.OP_OR: "either({0}, {1})",
    ca.OP_NOT: "negation({0})",
    ca.OP_IF_ELSE_ZERO: "where({0}, {1})",
    ca.OP_SQRT: "square_root({0})",
    ca.OP_EXP: "exponential({0})",
    ca.OP_LOG: "logarithm({0})",
    ca.OP_SIN: "sine({0})",
    ca.OP_COS: "cosine({0})",
    ca.OP_TAN: "tangent({0})",
    ca.OP_ASIN: "arcsine({0})",
    ca.OP_ACOS: "arccosine({0})",
    ca.OP_ATAN: "arctangent({0})",
    ca.OP_SINH: "hyperbolic_sine({0})",
    ca.OP_COSH: "hyperbolic_cosine({0})",
    ca.OP_TANH: "hyperbolic_tangent({0})",
    ca.OP_FABS: "magnitude({0})",
    ca.OP_SIGN: "sign({0})",
    ca.OP_FLOOR: "round_down({0})",
    ca.OP_CEIL: "round_up({0})",
    ca.OP_ERF: "error_function({0})",
    ca.OP_POW: "power({0}, {1})",
    ca.OP_CONSTPOW: "power({0}, {1})",
    ca.OP_ATAN2: "arctangent_2({0}, {1})",
    ca.OP_FMIN: "smaller({0}, {1})",
    ca.OP_FMAX: "larger({0}, {1})",
    ca.OP_COPYSIGN: "with_sign({0}, {1})",
    ca.OP_FMOD: "remainder_of({0}, {1})",
}
"""C of each operation of CasADi's, by its operands; functions are those of lanes.h."""


@dataclass(frozen=True)
class _Statement:
    """A value, or an output where `target` names one, from operands: C text, or the value's number."""

    expression: str
    operands: tuple[str | int, ...]
    target: str = ""


def c_source(function: ca.Function, lanes: int = 1) -> str:
    """C source of a function of dense or sparse arguments, nonzeros column by column.

    lanes 1: of the interface that `casadi.external` loads. Otherwise `int NAME(const real **, real **)`, of
    arguments and results; real is a vector of `lanes` doubles: each entry holds that of `lanes` designs.
    ValueError for an operation that `EXPRESSIONS` lacks.
    """
    pieces = _pieces(_statements(function))
    name, inputs, outputs = function.name(), range(function.n_in()), range(function.n_out())
    parameters = [
        *(f"const real *x{i}" for i in inputs),
        *(f"real *restrict y{i}" for i in outputs),
        "real *restrict w",
    ]
    arguments = [*(f"arg[{i}]" for i in inputs), *(f"res[{i}]" for i in outputs), "w"]
    texts, room = _piece_texts(pieces)
    lines = [f"#define LANES {lanes}", LANES_HEADER.read_text()]
    for i, text in enumerate(texts):
        lines += [f"static __attribute__((noinline)) void piece_{i}({', '.join(parameters)}) {{", *text, "}"]
    calls = [f"piece_{i}({', '.join(arguments)});" for i in range(len(texts))]
    header = "const real **arg, real **res"
    if lanes == 1:
        lines.append(_casadi_interface(function))
        header += ", long long *iw, double *memory, int instance"
    lines += [f"int {name}({header}) {{", f"real w[{max(1, room)}];", *calls, "return 0;", "}"]
    return "\n".join(lines) + "\n"


def _statements(function: ca.Function) -> dict[int, _Statement]:
    """By number, in order; inputs and constants stand in the operands."""
    values: dict[int, str | int] = {}  # what CasADi's memory holds at each place
    out: dict[int, _Statement] = {}
    for k in range(function.n_instructions()):
        code = function.instruction_id(k)
        places = function.instruction_output(k)
        if code == ca.OP_CONST:
            values[places[0]] = f"CONSTANT({_literal(function.instruction_constant(k))})"
            continue
        operands = function.instruction_input(k)
        if code == ca.OP_INPUT:
            values[places[0]] = f"x{operands[0]}[{operands[1]}]"
        elif code == ca.OP_OUTPUT:
            out[k] = _Statement("{0}", (values[operands[0]],), f"y{places[0]}[{places[1]}]")
        elif code in EXPRESSIONS:
            out[k] = _Statement(EXPRESSIONS[code], tuple(values[i] for i in operands))
            values[places[0]] = k
        else:
            raise ValueError(f"operation {code} of {function.name()} has no C expression in EXPRESSIONS")
    return out


def _literal(value: float) -> str:
    """A double in C."""
    if value != value:
        return "NAN"
    return repr(value) if abs(value) < float("inf") else "INFINITY" if value > 0.0 else "-INFINITY"


def _pieces(statements: dict[int, _Statement]) -> list[list[tuple[int, _Statement]]]:
    items = list(statements.items())
    return [items[i : i + PIECE] for i in range(0, len(items), PIECE)]


def _piece_texts(pieces: list[list[tuple[int, _Statement]]]) -> tuple[list[list[str]], int]:
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
            lines.append(f"const real v{k} = {value};")
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
