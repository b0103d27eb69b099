"""`kc.predict`: what a saved surrogate says of designs of a table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.surrogate_models.saved import load_surrogate
from doe_kc.workflow.predict import predict_table, prediction_columns

if TYPE_CHECKING:
    import pandas as pd


def predict(surrogate: str | Path, designs: str | Path, *, fill: bool = False) -> pd.DataFrame:
    """Means and standard deviations of the characteristics of designs, in their units; one row a design.

    surrogate: `surrogate.npz`, as `kc.surrogates(...).write` and `doe-kc surrogates` write it. designs: CSV
    or Excel file, one row a design and one column a variable, absolute values. fill: variables without a
    column keep their start values. Columns: label, then for each characteristic its id and `ID sd`.
    InputError naming file, row and column for what cannot be read.

    >>> sampling = kc.sample("examples/front_axle", 24, out="sampled", workers=1)
    >>> _ = kc.surrogates("examples/front_axle", ["linear"], out="sampled", workers=1).write("sampled")
    >>> sampling.designs.head(2).to_csv("designs.csv", index=False)
    >>> kc.predict("sampled/surrogates/surrogate.npz", "designs.csv").shape[0]
    2
    """
    import pandas as pd

    predicted = predict_table(load_surrogate(Path(surrogate)), Path(designs), fill=fill)
    return pd.DataFrame(prediction_columns(predicted))
