"""Lists of operations: no value twice, operands by number, what they lack."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from doe_kc.solver.dialect import EXPRESSIONS
from doe_kc.solver.library import CompileError
from doe_kc.solver.operations import Recorder, operations_of


def test_operands_are_operations_from_0_on_and_arguments_and_constants_below() -> None:
    x, y = ca.SX.sym("x", 2), ca.SX.sym("y")
    own = operations_of(ca.Function("f", [x, y], [ca.vertcat(x[1] * y, ca.sin(x[1] * y) + 0.25, y)]))
    assert own.sizes == (2, 1)
    np.testing.assert_array_equal(own.constants, [0.25])
    product, sine, total = own.rows.tolist()
    assert (product[0], set(product[1:])) == (ca.OP_MUL, {-2, -3})
    assert sine == [ca.OP_SIN, 0, 0]
    assert (total[0], set(total[1:])) == (ca.OP_ADD, {1, -4})
    np.testing.assert_array_equal(own.results, [[0, 0, 0], [0, 1, 2], [0, 2, -3]])


def test_the_same_value_is_one_operation_whatever_the_order_of_a_sum_or_product() -> None:
    recorder = Recorder(2)
    assert recorder.operation(ca.OP_MUL, -1, -2) == recorder.operation(ca.OP_MUL, -2, -1) == 0
    assert recorder.operation(ca.OP_SUB, -1, -2) != recorder.operation(ca.OP_SUB, -2, -1)
    assert [recorder.constant(v) for v in (1.0, 2.0)] == [-3, -4]


def test_an_operation_without_c_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    x = ca.SX.sym("x")
    monkeypatch.delitem(EXPRESSIONS, ca.OP_SIN)
    with pytest.raises(CompileError, match=rf"operation {ca.OP_SIN} of f has no C expression"):
        operations_of(ca.Function("f", [x], [ca.sin(x)]))
