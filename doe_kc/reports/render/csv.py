"""A table as columns or as a data frame, for a CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from doe_kc.reports.table import Row, Table

if TYPE_CHECKING:
    import pandas as pd


def table_columns(table: Table[Row]) -> dict[str, list[Any]]:
    """One column a key; what is unknown (None) is empty text, what is no number stays nan."""
    return {
        c.key: ["" if (v := c.value(row)) is None else v for row in table.rows]
        for c in table.columns
        if c.csv
    }


def table_frame(table: Table[Row]) -> pd.DataFrame:
    """`table_columns` as a data frame."""
    import pandas as pd

    return pd.DataFrame(table_columns(table))
