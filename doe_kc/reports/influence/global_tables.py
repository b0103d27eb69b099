"""The tables of global sensitivities: indices beside the slopes, where they disagree, how far they
converged."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from doe_kc.characteristics import Characteristic
from doe_kc.load_cases import case_label
from doe_kc.parameter_influence.global_sensitivity import (
    CONVERGENCE_SHARES,
    SIMULTANEOUS,
    WEAK_SHARE,
    Disagreement,
    GlobalSensitivity,
    MethodResult,
)
from doe_kc.reports.characteristic_columns import CHARACTERISTIC_COLUMNS
from doe_kc.reports.influence.global_words import METHODS_LEAD
from doe_kc.reports.table import Bar, Column, PageCell, PageLayout, SheetLayout, Table, three_digits
from doe_kc.variables import Variable


@dataclass(frozen=True)
class GlobalRow:
    """One variable i and characteristic k of a result."""

    result: GlobalSensitivity
    i: int
    k: int

    @property
    def entry(self) -> Characteristic:
        """The characteristic."""
        return self.result.characteristics[self.k]

    @property
    def variable(self) -> Variable:
        """The variable."""
        return self.result.variables[self.i]

    @property
    def share(self) -> float:
        """Of the variance by slopes."""
        return float(self.result.shares[self.i, self.k])

    @property
    def effect(self) -> float:
        """Slope times range, in the characteristic's unit."""
        return float(self.result.effects[self.i, self.k])


def global_table(result: GlobalSensitivity, *, every: bool = False) -> Table[GlobalRow]:
    """One row a variable and characteristic, the largest first within a characteristic; those of less than 1
    % by slopes and by every method are left out unless `every`."""
    rows = []
    for k in range(len(result.characteristics)):
        size = _size(result, k)
        rows += [
            GlobalRow(result, int(i), k)
            for i in np.argsort(-size, kind="stable")
            if every or size[i] >= WEAK_SHARE
        ]
    columns: tuple[Column[GlobalRow], ...] = (
        *CHARACTERISTIC_COLUMNS,
        Column("variable", "Variable", lambda r: r.variable.path, width=14, page=PageCell()),
        Column("effect", "By slope: effect over the range", lambda r: r.effect,
               lambda r: three_digits(r.effect), 14, page=PageCell("by slope, per range", digits=3)),
        Column("share", "By slopes: share of the variance", lambda r: r.share, "0.0%", 14,
               page=PageCell("by slopes, share", layout=".1%")),
        *(c for m in result.methods for c in _index_columns(m)),
    )  # fmt: skip
    return Table(
        "Global",
        "Over the ranges of the variables, by the true solver; ±: half width of the 95 % interval.",
        columns,
        rows,
        title="Global sensitivities",
        colors=(Bar("share", "5AA5DC", 1.0),),
        sheet=SheetLayout(frozen="variable", pages_wide=2, repeat_columns="A:A", first=("name", "load_case")),
        page=PageLayout("global", "Global sensitivities", filtered=True),
    )


def _size(result: GlobalSensitivity, k: int) -> np.ndarray:
    """(d,) largest share that slopes or a method see."""
    sizes = [result.shares[:, k]]
    for method in result.methods:
        main = method.index(method.main)
        values = main.values[:, k]
        if method.id == "morris":
            values = values / max(float(values.max()), 1e-300)
        elif method.id == "pawn":
            margin = SIMULTANEOUS * main.error[:, k]
            values = np.where(values - margin > method.index("chance").values[:, k], values, 0.0)
        else:
            values = values - main.error[:, k]
        sizes.append(values)
    return np.asarray(np.max(sizes, axis=0))


def _index_columns(method: MethodResult) -> list[Column[GlobalRow]]:
    out: list[Column[GlobalRow]] = []
    for index in method.indices:

        def value(row: GlobalRow, values: Any = index.values) -> float:
            return float(values[row.i, row.k])

        def error(row: GlobalRow, errors: Any = index.error) -> float:
            return float(errors[row.i, row.k])

        share = method.id == "sobol"
        plain = "0.0%" if share else ("0.000" if method.id == "pawn" else "")
        head = f"{method.label}: {index.label}"
        page = PageCell[GlobalRow](head, layout=".1%") if share else PageCell[GlobalRow](head, digits=3)
        key = f"{method.id}_{index.id}"
        digits = plain or (lambda row, of=value: three_digits(of(row)))
        out.append(Column(key, head, value, digits, 13, page=page))
        if np.isfinite(index.error).any():
            page = PageCell[GlobalRow]("±", layout=".1%") if share else PageCell[GlobalRow]("±", digits=2)
            out.append(Column(f"{key}_error", "±", error, digits, 9, page=page))
    return out


def disagreement_table(result: GlobalSensitivity) -> Table[Disagreement]:
    """One row a variable, characteristic and method, the largest difference first."""
    columns: tuple[Column[Disagreement], ...] = (
        Column("characteristic", "Characteristic", lambda d: d.characteristic.id, width=32),
        Column("variable", "Variable", lambda d: d.variable.path, width=16),
        Column("method", "Method", lambda d: d.method),
        Column("by_slope", "By slope", lambda d: d.local, lambda d: three_digits(d.local)),
        Column("overall", "Over the range", lambda d: d.overall, lambda d: three_digits(d.overall), 12),
        Column("error", "±", lambda d: d.error, lambda d: three_digits(d.error)),
        Column(
            "missed",
            "Beyond the slope",
            lambda d: d.missed if math.isfinite(d.missed) else None,
            lambda d: three_digits(d.missed),
            12,
        ),
        Column("sentence", "In words", lambda d: d.sentence, width=90),
    )
    return Table(
        "Not linear",
        "Where the slopes of the unchanged axle miss what a method sees over the ranges.",
        columns,
        result.disagreements(),
        title="Where the model is not linear over the ranges",
        empty="Nowhere: slopes and global methods agree.",
        sheet=SheetLayout(frozen="method", wrapped=True),
    )


@dataclass(frozen=True)
class ConvergenceRow:
    """One method and characteristic; errors: of CONVERGENCE_SHARES. first: sum of the shares alone, nan where
    the method gives none."""

    method: MethodResult
    entry: Characteristic
    errors: tuple[float, ...]
    change: float
    first: float
    explained: float


def convergence_table(result: GlobalSensitivity) -> Table[ConvergenceRow]:
    """One row a method and characteristic."""
    rows = []
    for method in result.methods:
        sums = method.index("first").values.sum(axis=0) if method.id == "sobol" else None
        for k, entry in enumerate(result.characteristics):
            errors = tuple(map(float, method.errors[:, k]))
            first = math.nan if sums is None else float(sums[k])
            row = ConvergenceRow(
                method, entry, errors, float(method.changes[k]), first, float(result.explained[k])
            )
            rows.append(row)

    def at(place: int) -> Column[ConvergenceRow]:
        share = f"{100.0 * CONVERGENCE_SHARES[place]:.0f} %"
        return Column(f"error_{place + 1}", f"± with {share} of the samples", lambda r: r.errors[place],
                      lambda r: three_digits(r.errors[place]), 13,
                      page=PageCell(f"± with {share}", digits=2))  # fmt: skip

    columns: tuple[Column[ConvergenceRow], ...] = (
        Column("method", "Method", lambda r: r.method.label, page=PageCell(style="first")),
        *CHARACTERISTIC_COLUMNS,
        Column("index", "Main index", lambda r: r.method.index(r.method.main).label, width=24,
               page=PageCell()),
        *(at(k) for k in range(len(CONVERGENCE_SHARES))),
        Column("change", "Change by the second half", lambda r: r.change, lambda r: three_digits(r.change),
               13, page=PageCell(digits=2)),
        Column("first", "Sum of the shares alone", lambda r: r.first, "0.0%", 12,
               page=PageCell(layout=".0%")),
        Column("explained", "Variance that slopes explain", lambda r: r.explained, "0.0%", 13,
               page=PageCell(layout=".1%")),
    )  # fmt: skip
    return Table(
        "Convergence",
        METHODS_LEAD,
        columns,
        rows,
        title="Convergence of the global sensitivities",
        sheet=SheetLayout(frozen="load_case", pages_wide=2),
        page=PageLayout("convergence-of-methods", "Convergence", filtered=True),
    )


def global_document(result: GlobalSensitivity) -> dict[str, Any]:
    """Method -> index -> `{"value", "error"}`, each characteristic -> variable -> number; `"not_linear"`:
    sentences; `"explained"`: characteristic -> share of the variance that slopes explain."""
    paths, ids = [v.path for v in result.variables], [c.id for c in result.characteristics]

    def nested(values: np.ndarray) -> dict[str, dict[str, float | None]]:
        return {
            ident: {p: _finite(v) for p, v in zip(paths, column, strict=True)}
            for ident, column in zip(ids, values.T, strict=True)
        }

    methods = {
        m.id: {i.id: {"value": nested(i.values), "error": nested(i.error)} for i in m.indices}
        | {"designs": m.designs, "failed": m.failed}
        for m in result.methods
    }
    return {
        **methods,
        "shares_by_slopes": nested(result.shares),
        "explained": {ident: _finite(v) for ident, v in zip(ids, result.explained, strict=True)},
        "not_linear": [d.sentence for d in result.disagreements()],
        "seconds": result.seconds,
    }


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def heading(entry: Characteristic) -> str:
    """Load case and name, two lines."""
    return f"{case_label(entry.load_case)}\n{entry.label}"
