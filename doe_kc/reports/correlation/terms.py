"""The terms of the rating (thesis, equation 2.2) and the deviations of the curves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any, Literal

import numpy as np

from doe_kc.characteristics import Characteristic
from doe_kc.correlation.result import Correlation
from doe_kc.curves import RESPONSE_LABELS, RESPONSE_UNITS
from doe_kc.load_cases import case_label
from doe_kc.reports.table import POSITIVE_FILL, Bar, Column, SheetLayout, Table, three_digits
from doe_kc.targets import Constraint, Objective, Rating, Score
from doe_kc.targets.options import Goal

Kind = Literal["objective", "curve", "constraint"]


@dataclass(frozen=True, kw_only=True)
class TermRow:
    """One term of the rating; target, low, high, norm, baseline, final in `unit`, nan where there is none.

    baseline, final: the characteristic's value or the curve's RMS deviation. sign: S. goal: what an objective
    is. baseline_term, final_term: LinWt S Obj / Norm + QuadWt S Obj^2 / Norm^2, or minus the same of ConViol.
    """

    kind: Kind
    id: str
    label: str
    unit: str
    goal: Goal | Literal[""] = ""
    target: float = np.nan
    low: float = np.nan
    high: float = np.nan
    linear: float
    quadratic: float
    norm: float
    sign: float
    baseline: float
    final: float
    baseline_term: float
    final_term: float


def term_rows(correlation: Correlation) -> list[TermRow]:
    """Objectives, curves, constraints; their terms sum to the rating."""
    return [*_objectives(correlation), *_curves(correlation), *_constraints(correlation)]


def term_columns(correlation: Correlation) -> dict[str, list[Any]]:
    """One row a term, with its weights."""
    rows = term_rows(correlation)
    return {f.name: [getattr(row, f.name) for row in rows] for f in fields(TermRow)}


def _weights(of: Objective | Constraint) -> dict[str, Any]:
    return {"linear": of.linear, "quadratic": of.quadratic, "norm": of.norm}


def _named(entry: Characteristic) -> dict[str, Any]:
    label = f"{case_label(entry.load_case)}: {entry.label}"
    return {"id": entry.id, "label": label, "unit": entry.unit}


def _judged(correlation: Correlation, part: str, terms: str, row: int) -> dict[str, Any]:
    """What the row has before and after; part: of the score. terms: of the rating."""
    before, after = correlation.baseline, correlation.best
    return {
        "baseline": _of(before.score, part, row),
        "final": _of(after.score, part, row),
        "baseline_term": _of(before.rating, terms, row),
        "final_term": _of(after.rating, terms, row),
    }


def _of(where: Score | Rating | None, part: str, row: int) -> float:
    return float(getattr(where, part)[row]) + 0.0 if where is not None else np.nan  # + 0: no minus zero


def _objectives(correlation: Correlation) -> Iterator[TermRow]:
    for i, t in enumerate(correlation.problem.targets.characteristics):
        if t.objective is not None:
            yield TermRow(
                kind="objective",
                goal=t.objective.goal,
                target=t.value,
                sign=t.objective.sign,
                **_named(t.entry),
                **_weights(t.objective),
                **_judged(correlation, "values", "objectives", i),
            )


def _constraints(correlation: Correlation) -> Iterator[TermRow]:
    for i, t in enumerate(correlation.problem.targets.characteristics):
        if t.constraint is not None:
            yield TermRow(
                kind="constraint",
                low=t.constraint.low,
                high=t.constraint.high,
                sign=-1.0,
                **_named(t.entry),
                **_weights(t.constraint),
                **_judged(correlation, "values", "constraints", i),
            )


def _curves(correlation: Correlation) -> Iterator[TermRow]:
    for i, t in enumerate(correlation.problem.targets.curves):
        yield TermRow(
            kind="curve",
            id=t.id,
            label=f"{case_label(t.load_case)}: {RESPONSE_LABELS[t.response]}, RMS",
            unit=RESPONSE_UNITS[t.response],
            sign=t.objective.sign,
            **_weights(t.objective),
            **_judged(correlation, "rms", "curves", i),
        )


@dataclass(frozen=True, kw_only=True)
class CurveRow:
    """One curve that is an objective: RMS deviations of both wheels, noise and Norm in `unit`."""

    id: str
    load_case: str
    response: str
    unit: str
    rms_baseline: float
    rms_final: float
    noise_rms: float
    norm: float


def curve_rows(correlation: Correlation) -> list[CurveRow]:
    """In the order of the targets."""
    return [
        CurveRow(
            id=t.id,
            load_case=t.load_case,
            response=t.response,
            unit=row.unit,
            rms_baseline=row.baseline,
            rms_final=row.final,
            noise_rms=t.noise,
            norm=row.norm,
        )
        for t, row in zip(correlation.problem.targets.curves, _curves(correlation), strict=True)
    ]


def curve_format(row: CurveRow) -> str:
    """Number format of its deviations: three digits of the noise."""
    return three_digits(row.noise_rms or row.rms_final)


CURVE_DEVIATION_COLUMNS: tuple[Column[CurveRow], ...] = (
    Column("id", None, lambda r: r.id),
    Column("load_case", "Load case", lambda r: r.load_case, width=28,
           words=lambda r: case_label(r.load_case)),
    Column("response", "Response", lambda r: r.response, width=32,
           words=lambda r: RESPONSE_LABELS[r.response]),
    Column("unit", "Unit", lambda r: r.unit, width=8),
    Column("rms_baseline", "RMS baseline", lambda r: r.rms_baseline, curve_format, 13),
    Column("rms_final", "RMS final", lambda r: r.rms_final, curve_format, 13),
    Column("noise_rms", "Noise RMS", lambda r: r.noise_rms, curve_format, 13),
    Column("final_over_noise", "Final / noise",
           lambda r: r.rms_final / r.noise_rms if r.noise_rms else np.nan, "0.00", 13, csv=False),
    Column("norm", "Norm", lambda r: r.norm, lambda r: three_digits(r.norm), 13),
    Column("final_percent", "Final, % of Norm", lambda r: 100.0 * r.rms_final / r.norm, "0.00", 13,
           csv=False),
)  # fmt: skip


def curve_table(correlation: Correlation) -> Table[CurveRow]:
    """RMS deviation of every curve that is an objective."""
    return Table(
        "Curves",
        "RMS deviation of both wheels' mean curves from the measured ones.",
        CURVE_DEVIATION_COLUMNS,
        curve_rows(correlation),
        colors=(Bar("final_percent", POSITIVE_FILL),),
        empty="No curve is an objective of this study.",
        sheet=SheetLayout(first=("load_case", "response")),
    )
