"""Every true-solver evaluation of a correlation, in order."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.correlation.problem import Evaluated
from doe_kc.correlation.result import Correlation
from doe_kc.ground.typing import FloatArray
from doe_kc.reports.table import Column, SheetLayout, Table, four_digits, three_digits
from doe_kc.variables.variable import Variable


@dataclass(frozen=True)
class History:
    """Merits of the search over n evaluations, all (n,).

    number: 1 = the baseline. rating: nan after a failure. best: largest so far. predicted, sd: what the
    method expected, nan where it expected nothing.
    """

    number: FloatArray
    origin: tuple[str, ...]
    rating: FloatArray
    best: FloatArray
    feasible: np.ndarray
    failed: np.ndarray
    predicted: FloatArray
    sd: FloatArray

    @property
    def first_feasible(self) -> int | None:
        """Number of the first evaluation that meets every constraint."""
        return int(self.number[np.argmax(self.feasible)]) if self.feasible.any() else None

    @property
    def origins(self) -> tuple[str, ...]:
        """What proposed designs, in order of appearance."""
        return tuple(dict.fromkeys(self.origin))


def history(correlation: Correlation) -> History:
    """Ratings of a run in order."""
    runs = correlation.run.evaluated
    merit = np.array([e.merit for e in runs])
    expected = [e.candidate.predicted for e in runs]
    return History(
        number=np.arange(1, len(runs) + 1, dtype=float),
        origin=tuple(e.candidate.origin for e in runs),
        rating=np.where(np.isfinite(merit), merit, np.nan),
        best=np.maximum.accumulate(merit),
        feasible=np.array([e.feasible for e in runs]),
        failed=np.array([e.rating is None for e in runs]),
        predicted=np.array([p.rating if p else np.nan for p in expected], dtype=float),
        sd=np.array([p.rating_sd if p else np.nan for p in expected], dtype=float),
    )


COLUMNS_PER_PAGE = 17
"""Columns of the sheet that fit the width of one printed page."""


@dataclass(frozen=True)
class EvaluationRow:
    """One evaluation: `index` in `past` and in the run. values: of every variable by path, absolute."""

    evaluated: Evaluated
    index: int
    past: History
    chosen: bool
    values: Mapping[str, float]


def evaluation_table(correlation: Correlation) -> Table[EvaluationRow]:
    """Every design that the true solver was asked for: its figures, then the value of every variable."""
    space, past = correlation.problem.space, history(correlation)
    rows = [
        EvaluationRow(e, i, past, i == correlation.run.best, space.values(e.point))
        for i, e in enumerate(correlation.run.evaluated)
    ]
    columns = (*EVALUATION_FIGURES, *(_variable(v) for v in space.variables))
    return Table(
        "Evaluations",
        "In order; the shaded one is handed over. Values are absolute.",
        columns,
        rows,
        flagged=lambda r: r.chosen,
        sheet=SheetLayout(
            frozen="best_so_far",
            pages_wide=-(-len(columns) // COLUMNS_PER_PAGE),
            repeat_columns="A:C",
        ),
    )


def _of_history(
    key: str,
    label: str,
    values: Callable[[History], FloatArray],
    digits: Callable[[float], str],
    width: float,
) -> Column[EvaluationRow]:
    """values: (n,) of the whole run, of which a row shows its own."""

    def value(row: EvaluationRow) -> float:
        return float(values(row.past)[row.index])

    return Column(key, label, value, lambda row: digits(value(row)), width)


EVALUATION_FIGURES: tuple[Column[EvaluationRow], ...] = (
    Column("evaluation", "Evaluation", lambda r: r.index + 1, "0"),
    Column("origin", "Origin", lambda r: r.past.origin[r.index], width=23),
    _of_history("merit", "Merit", lambda h: h.rating, four_digits, 13),
    _of_history("best_so_far", "Best so far", lambda h: h.best, four_digits, 13),
    Column("feasible", "Feasible", lambda r: bool(r.past.feasible[r.index]), width=9),
    Column("chosen", "Chosen", lambda r: r.chosen, width=9),
    Column("failed_because", "Failed because", lambda r: r.evaluated.outcome.reason, width=34),
    _of_history("predicted_merit", "Predicted merit", lambda h: h.predicted, four_digits, 13),
    _of_history("predicted_sd", "Predicted sd", lambda h: h.sd, three_digits, 12),
    Column("seconds", "Seconds", lambda r: r.evaluated.outcome.seconds, "0.00", 9),
)


def _variable(variable: Variable) -> Column[EvaluationRow]:
    """Its head breaks at its blank only, so that the column is as wide as the path; three digits of a tenth
    of the range."""
    path, unit = variable.path, variable.unit
    head = f"{path}, {unit}" if unit else path
    number = three_digits((variable.upper - variable.lower) / 10.0)
    width = max(11.0, 1.1 * len(head.split(",")[0]) + 1.0)
    return Column(path, head, lambda r: r.values[path], number, width)
