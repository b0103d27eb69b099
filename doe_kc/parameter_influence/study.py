"""The influence study: one parameter at a time by the true solver, exact sensitivities beside."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from doe_kc.axle.design_parameters import Parameter, design_parameters
from doe_kc.axle.model import Axle
from doe_kc.campaign.runner import Campaign
from doe_kc.characteristics import CHARACTERISTICS, Characteristic, appendix_c
from doe_kc.ground.errors import RunError
from doe_kc.ground.threads import one_thread
from doe_kc.ground.typing import FloatArray
from doe_kc.sampling.one_at_a_time import one_at_a_time
from doe_kc.solver.curve_gradient import characteristic_gradients
from doe_kc.solver.suite import solve
from doe_kc.true_solver.outcome import Outcome
from doe_kc.true_solver.own import AxleSolver

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


@one_thread()
def influence_study(
    axle: Axle,
    parameters: Sequence[Parameter] | None = None,
    characteristics: Sequence[Characteristic] | None = None,
    *,
    workers: int | None = None,
    windows: Mapping[str, float] | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> Influence:
    """Central one-at-a-time runs of +-1 mm and +-10 % and exact sensitivities of the nominal axle.

    parameters: all design parameters by default; characteristics: the 21 columns of Appendix C. An axle
    without equilibrium leaves nan and its reason in `failures`. RunError when the nominal axle has none.
    """
    started = time.perf_counter()
    rows = list(parameters) if parameters is not None else design_parameters(axle)
    columns = list(characteristics) if characteristics is not None else appendix_c()
    with Campaign(AxleSolver(axle, dict(windows or {}), curves=False), workers=workers) as campaign:
        designs = list(one_at_a_time(rows).rows())
        outcomes = campaign.evaluate(designs, "influence", progress, curves=False)
    if outcomes[0].failed:
        raise RunError(f"the nominal axle cannot be solved: {outcomes[0].reason}")
    index = [list(CHARACTERISTICS).index(c.id) for c in columns]
    values = np.array([o.characteristics[index] for o in outcomes])
    plus, minus = values[1::2], values[2::2].copy()
    for i, parameter in enumerate(rows):
        if parameter.one_sided:  # so that (plus - minus) / 2 is the whole one-sided change
            minus[i] = 2.0 * values[0] - plus[i]
    return Influence(
        parameters=tuple(rows),
        characteristics=tuple(columns),
        baseline=values[0],
        plus=plus,
        minus=minus,
        exact=exact_changes(axle, rows, columns, windows),
        seconds=time.perf_counter() - started,
        failures=_failures(rows, outcomes),
    )


def exact_changes(
    axle: Axle,
    rows: Sequence[Parameter],
    columns: Sequence[Characteristic],
    windows: Mapping[str, float] | None = None,
) -> FloatArray:
    """(parameters, characteristics) exact derivative times the parameter's step."""
    paths = [p.path for p in rows]
    gradients = characteristic_gradients(axle, solve(axle), paths, columns, windows=windows).T
    return np.asarray(gradients * np.array([p.step for p in rows])[:, None])


def _failures(rows: Sequence[Parameter], outcomes: Sequence[Outcome]) -> dict[str, str]:
    out = {}
    for i, parameter in enumerate(rows):
        reasons = [o.reason for o in outcomes[1 + 2 * i : 3 + 2 * i] if o.failed]
        if reasons:
            out[parameter.path] = reasons[0]
    return out
