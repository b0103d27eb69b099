"""The tables of a comparison, as CSV, JSON and in a terminal."""

from __future__ import annotations

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import RESPONSE_UNITS
from doe_kc.reports.comparison.tables import compared_characteristic_table, compared_curve_table
from doe_kc.reports.render.csv import table_frame
from doe_kc.reports.render.json import table_records
from doe_kc.reports.render.terminal import table_lines
from doe_kc.targets.comparison import compare
from tests.targets.test_comparison import BRAKE, VERTICAL, curve_set


def test_tables_hold_one_row_each() -> None:
    comparison = compare(curve_set(VERTICAL, BRAKE), curve_set(VERTICAL, BRAKE))
    table = table_frame(compared_characteristic_table(comparison))
    assert list(table["name"]) == [c.entry.id for c in comparison.characteristics]
    assert list(table["unit"]) == [CHARACTERISTICS[n].unit for n in table["name"]]
    assert table["inside"].all() and (table["high"] > table["low"]).all()
    curves = table_frame(compared_curve_table(comparison))
    assert len(curves) == len(comparison.curves)
    assert list(curves["unit"]) == [RESPONSE_UNITS[r] for r in curves["response"]]
    assert table_records(compared_curve_table(comparison)) == curves.to_dict("records")
    lines = table_lines(compared_characteristic_table(comparison))
    assert lines[0] == f"{'characteristic':34}{'model':>12}{'target':>12}{'difference':>12}  unit"
    first = comparison.characteristics[0]
    same = f"{first.value:>12.5g}{first.value:>12.5g}{0.0:>12.3g}"
    assert lines[1] == f"{first.entry.id:34}{same}  {first.entry.unit}"
