"""A table as records, for a JSON document."""

from __future__ import annotations

from doe_kc.reports.table import Row, Table, Value


def table_records(table: Table[Row]) -> list[dict[str, Value]]:
    """One record a row; numbers as they are."""
    columns = [c for c in table.columns if c.json]
    return [{c.json: c.value(row) for c in columns} for row in table.rows]
