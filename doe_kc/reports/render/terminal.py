"""A table as lines of text, for a terminal."""

from __future__ import annotations

from doe_kc.reports.table import Row, Table, TerminalCell, Value


def table_lines(table: Table[Row]) -> list[str]:
    """Heads, then one line a row."""
    columns = [(c.terminal, c.value) for c in table.columns if c.terminal is not None]
    lines = ["".join(format(cell.head, cell.layout) for cell, _ in columns)]
    for row in table.rows:
        texts = (format(_text(cell, value(row), row), cell.layout) for cell, value in columns)
        lines.append("".join(texts))
    return lines


def _text(cell: TerminalCell[Row], value: Value, row: Row) -> str:
    return cell.text(row) if cell.text is not None else format(value, cell.number)
