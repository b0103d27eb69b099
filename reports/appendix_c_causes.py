"""What moves the agreement with Appendix C: one change of the example, its rounding or its windows a line."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from doe_kc.axle import Axle, with_values
from doe_kc.axle.design_parameters import design_parameters
from doe_kc.characteristics import Characteristic
from doe_kc.parameter_influence.study import influence_study, percent_of_column

DIGIT = {
    "roll.camber_change": 5,
    "steer.steering_ratio": 20,
    "lateral.camber_change": 3,
    "lateral.toe_change": 11,
    "lateral.wc_lateral_disp": 14,
    "lateral_offset.camber_change": 4,
    "lateral_offset.toe_change": 12,
    "lateral_offset.wc_lateral_disp": 13,
    "drive.drive_steer": 22,
    "brake.brake_steer": 37,
}
"""Largest entry of a published column in last digits of its output, from the steps between its entries."""
WIDE: Mapping[str, float] = {
    "vertical": 60.0, "roll": 3.0, "steer": 300.0,
    "lateral": 2000.0, "lateral_offset": 2000.0, "drive": 2000.0, "brake": 2000.0,
}  # fmt: skip
"""Windows two to three times the default ones."""


def matrix(
    axle: Axle,
    rows: pd.Index,
    columns: list[Characteristic],
    windows: Mapping[str, float] | None = None,
) -> pd.DataFrame:
    """Percent of each column's largest entry for the rows of Appendix C."""
    known = {p.path: p for p in design_parameters(axle)}
    study = influence_study(axle, [known[r.replace(" ", ".")] for r in rows], columns, windows=windows)
    return pd.DataFrame(percent_of_column(study.absolute), index=rows, columns=[c.id for c in columns])


def magnitudes(own: pd.DataFrame, published: pd.DataFrame) -> pd.Series:
    """Correlation of the magnitudes, column by column."""
    return pd.Series({c: np.corrcoef(own[c].abs(), published[c].abs())[0, 1] for c in published})


def rounded(own: pd.DataFrame) -> pd.DataFrame:
    """The matrix as if its outputs had the published number of digits."""
    out = own.copy()
    for name, digits in DIGIT.items():
        step = 100.0 / digits
        out[name] = (own[name] / step).round() * step
    return out


def causes(
    axle: Axle, own: pd.DataFrame, published: pd.DataFrame, columns: list[Characteristic]
) -> pd.DataFrame:
    """One row an experiment: mean over the columns, and the columns that it is about."""
    rows, without = published.index, ~published.index.isin(["upb Fy", "upb Tz"])
    cases = {
        "as it is": magnitudes(own, published),
        "tie rod inner joint 30 mm further back": magnitudes(
            matrix(with_values(axle, {"RIB.x": 182.0}), rows, columns), published
        ),
        "rear arm bush 0.4 times as stiff laterally": magnitudes(
            matrix(with_values(axle, {"llr.Fx": 0.4}), rows, columns), published
        ),
        "rounded to the published digits": magnitudes(rounded(own), published),
        "without the rows upb Fy and upb Tz": magnitudes(own[without], published[without]),
        "fit windows two to three times as wide": magnitudes(matrix(axle, rows, columns, WIDE), published),
    }
    table = pd.DataFrame(cases).T
    shown = ["roll.camber_change", "lateral.camber_change", "drive.drive_steer", "brake.brake_steer"]
    return table[shown].assign(mean=table.mean(axis=1))
