"""A column of numbers read at once is what its cells say one by one, good or bad."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.measurement import tables
from doe_kc.measurement.tables import Cell, RecordTable, column_numbers, number_at

TEXTS = ("1", "-2.5", "+.5", "3.", "1e-3", "-7.25E+02", "0012")
BAD: tuple[Cell, ...] = (
    *("", " ", "nan", "inf", "1e999", "0x1f", "1_000", "1,5", "1.5.2", "1 2", "1\n2", "--1", "e5", "\u0663"),
    *(None, True, float("nan"), float("inf")),
)


def table(cells: Sequence[Cell], *, decimal_comma: bool = False) -> RecordTable:
    numbers = tuple(range(2, 2 + len(cells)))
    return RecordTable("r.csv", ("time", "toe"), tuple(("0", c) for c in cells), numbers, decimal_comma)


def one_by_one(read: RecordTable) -> list[float]:
    return [number_at(read, row, 1) for row in range(len(read.rows))]


@pytest.mark.parametrize("cells", [TEXTS, (1.5, -2, 3.25), ("1", 2.5, 3)], ids=["texts", "numbers", "mixed"])
def test_a_good_column_is_read_as_its_cells(cells: Sequence[Cell]) -> None:
    read = table(cells)
    np.testing.assert_array_equal(column_numbers(read, 1), one_by_one(read))


def test_decimal_commas_are_read_where_the_table_has_them() -> None:
    read = table(["1,5", "-,25", "2"], decimal_comma=True)
    np.testing.assert_array_equal(column_numbers(read, 1), [1.5, -0.25, 2.0])


@pytest.mark.parametrize("others", [TEXTS, (1.0, 2.0)], ids=["texts", "numbers"])
@pytest.mark.parametrize("bad", BAD, ids=repr)
def test_a_bad_cell_is_named_by_the_same_sentence(bad: Cell, others: Sequence[Cell]) -> None:
    read = table([*others, bad, *others])
    with pytest.raises(InputError) as slow:
        one_by_one(read)
    with pytest.raises(InputError) as fast:
        column_numbers(read, 1)
    assert str(fast.value) == str(slow.value)
    assert f"row {2 + len(others)}, column" in str(fast.value)


def test_good_columns_do_not_go_cell_by_cell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(tables, "number_at")
    assert column_numbers(table(TEXTS), 1).shape == (len(TEXTS),)
    assert column_numbers(table([1.0, 2]), 1).tolist() == [1.0, 2.0]
