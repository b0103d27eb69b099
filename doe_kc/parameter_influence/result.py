"""What the influence study finds: one row a parameter, one column a characteristic."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from doe_kc.axle.parameters import Parameter
from doe_kc.characteristics import Characteristic
from doe_kc.ground.typing import FloatArray

if TYPE_CHECKING:
    import pandas as pd

NONLINEAR_PERCENT = 5.0
"""A cell is flagged when one-at-a-time and exact change differ by more than this share of the larger one
and by more than half a percent of the column's peak; below that it is rounding."""


@dataclass(frozen=True)
class Influence:
    """All arrays are (parameters, characteristics) unless said otherwise, in the characteristic's unit.

    baseline: (characteristics,) values of the unchanged axle.
    plus, minus: values with the parameter raised and lowered by its step; nan where the axle failed.
    exact: d(characteristic)/d(parameter) of the baseline times the step; nan where there is none.
    failures: parameter path -> reason, for axles that have no equilibrium.
    """

    parameters: tuple[Parameter, ...]
    characteristics: tuple[Characteristic, ...]
    baseline: FloatArray
    plus: FloatArray
    minus: FloatArray
    exact: FloatArray
    seconds: float
    failures: dict[str, str] = field(default_factory=dict)

    @cached_property
    def absolute(self) -> FloatArray:
        """Change for a positive step, (plus - minus) / 2."""
        return (self.plus - self.minus) / 2.0

    @cached_property
    def percent(self) -> FloatArray:
        """Percent of the largest magnitude of each column; + = positive change for a positive input."""
        return percent_of_column(self.absolute)

    @cached_property
    def exact_percent(self) -> FloatArray:
        """The exact changes in percent of the column's largest one-at-a-time magnitude."""
        return 100.0 * self.exact / column_peaks(self.absolute)

    @cached_property
    def nonlinear(self) -> np.ndarray:
        """bool: one-at-a-time and exact change differ by more than 5 %."""
        gap = np.abs(self.percent - self.exact_percent)
        reference = np.maximum(np.abs(self.percent), np.abs(self.exact_percent))
        with np.errstate(invalid="ignore"):
            return np.asarray((gap > NONLINEAR_PERCENT / 100.0 * reference) & (gap > 0.5))

    def only(self, characteristics: Sequence[Characteristic]) -> Influence:
        """The same study with these columns, in this order; ValueError for one that it lacks."""
        index = [self.characteristics.index(c) for c in characteristics]
        return replace(
            self,
            characteristics=tuple(characteristics),
            baseline=self.baseline[index],
            plus=self.plus[:, index],
            minus=self.minus[:, index],
            exact=self.exact[:, index],
        )

    def columns(self, values: FloatArray) -> dict[str, Any]:
        """`values` with a first column of parameter paths, then one a characteristic."""
        ids = (c.id for c in self.characteristics)
        return {"parameter": [p.path for p in self.parameters], **dict(zip(ids, values.T, strict=True))}

    def frame(self, values: FloatArray) -> pd.DataFrame:
        """`values` with parameter paths as index and characteristic ids as columns."""
        import pandas as pd

        return pd.DataFrame(
            values,
            index=[p.path for p in self.parameters],
            columns=[c.id for c in self.characteristics],
        )


def column_peaks(values: FloatArray) -> FloatArray:
    """(characteristics,) largest magnitude of each column; nan for a column without any entry."""
    finite = np.where(np.isfinite(values), np.abs(values), 0.0)
    peaks = finite.max(axis=0)
    return np.where(peaks > 0, peaks, np.nan)


def percent_of_column(values: FloatArray) -> FloatArray:
    """Percent of each column's largest magnitude; zero columns stay zero, nan entries nan."""
    percent = np.nan_to_num(100.0 * values / column_peaks(values))
    return np.where(np.isnan(values), np.nan, percent)
