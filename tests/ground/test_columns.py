"""Tables written as columns beside those that pandas writes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from doe_kc.ground.output import write_columns, write_csv

NAN = float("nan")


@pytest.mark.parametrize(
    "column",
    [
        [1, 2, -3],
        [1.0, 1e-17 / 3.0, -123456789.123456789],
        [1, 2.5, NAN],
        ["a", 'quoted "b", c', "two\nlines"],
        ["", 0.1 + 0.2, 7],
        [True, False, True],
        [None, "x", ""],
        [np.float64(1.0) / 3.0, np.int64(4), float("inf")],
        np.array([0.1, 1e300, NAN]),
        np.array([1, 2, 3]),
        np.array(["a", "b", "c"], dtype=object),
    ],
)
def test_columns_are_written_as_by_pandas(tmp_path: Path, column: Any) -> None:
    columns = {"name, unit": ["x", "y", "z"], "value": column}
    own = write_columns(tmp_path / "own.csv", columns)
    assert own.read_bytes() == write_csv(tmp_path / "peer.csv", pd.DataFrame(columns)).read_bytes()
