"""A table as a data frame, for a CSV."""

from __future__ import annotations

from typing import Any

import pandas as pd

from doe_kc.report.table import Row, Table


def table_frame(table: Table[Row]) -> pd.DataFrame:
    """One column a key; what is unknown (None) is empty text, what is no number stays nan."""
    columns = [c for c in table.columns if c.csv]
    records: list[dict[str, Any]] = []
    for row in table.rows:
        values = {c.key: c.value(row) for c in columns}
        records.append({key: "" if v is None else v for key, v in values.items()})
    return pd.DataFrame(records, columns=[c.key for c in columns])
