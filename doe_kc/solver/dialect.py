"""How the values of CasADi's operations are written in C: as numbers, or as several side by side."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca

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
