"""Tables of a surrogate study: quality, predictions, influence, shares."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from doe_kc.characteristics import Characteristic
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.render.json import table_records
from doe_kc.reports.table import Column, SheetLayout, Table, TerminalCell, Value, three_digits
from doe_kc.surrogate_models.models import SURROGATES
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.surrogate_models.study import Judged
from doe_kc.surrogate_models.validation import Quality


@dataclass(frozen=True)
class QualityRow:
    """What cross-validation says of a model for one characteristic. chosen: whether it is the model in use.
    index: of the characteristic in all arrays."""

    entry: Characteristic
    model: str
    fit: Judged
    index: int
    chosen: bool

    @property
    def id(self) -> str:
        """`load_case.name`."""
        return self.entry.id

    @property
    def limits(self) -> tuple[float, float]:
        """Between which the calibrated coverage of new designs is with 95 % confidence."""
        low, high = self.fit.limits
        return float(low[self.index]), float(high[self.index])

    @property
    def quality(self) -> Quality:
        """Arrays over all characteristics."""
        return self.fit.quality


QUALITY_COLUMNS: tuple[Column[QualityRow], ...] = (
    Column("characteristic", "Characteristic", lambda r: r.id, width=34, words=lambda r: r.entry.label,
           terminal=TerminalCell("characteristic", "32")),
    Column("load_case", "Load case", lambda r: case_label(r.entry.load_case), width=24, csv=False),
    Column("model", "Model", lambda r: r.model, width=36, words=lambda r: SURROGATES[r.model].label,
           terminal=TerminalCell("model", ">10")),
    Column("chosen", None, lambda r: r.chosen),
    Column("q2", "Q2", lambda r: float(r.quality.q2[r.index]), "0.0000", 12, json="q2",
           terminal=TerminalCell("Q2", ">9", ".4f")),
    Column("rmse", "RMSE", lambda r: float(r.quality.rmse[r.index]),
           lambda r: three_digits(float(r.quality.rmse[r.index])), 12, json="rmse",
           terminal=TerminalCell("rmse", ">11", ".3g")),
    Column("unit", "Unit", lambda r: r.entry.unit, width=9, json="unit",
           terminal=TerminalCell(" unit", "11", text=lambda r: f" {r.entry.unit}")),
    Column("coverage", "Coverage", lambda r: float(r.quality.coverage[r.index]), "0.0000", 12,
           json="coverage", terminal=TerminalCell("coverage", ">9", ".2f")),
    Column("calibrated_coverage", "Calibrated", lambda r: float(r.fit.covered[r.index]), "0.0000", 12,
           json="calibrated_coverage", terminal=TerminalCell("calibrated", ">11", ".2f")),
    Column("calibrated_low", "Calibrated, at least", lambda r: r.limits[0], "0.0000", 12,
           json="calibrated_low"),
    Column("calibrated_high", "Calibrated, at most", lambda r: r.limits[1], "0.0000", 12,
           json="calibrated_high"),
    Column("sharpness", "Sharpness", lambda r: float(r.quality.sharpness[r.index]), "0.0000", 12,
           json="sharpness"),
    Column("variance_factor", None, lambda r: float(r.fit.factors[r.index]), json="variance_factor"),
)  # fmt: skip


def quality_table(report: SurrogateReport) -> Table[QualityRow]:
    """One row a characteristic and model; `chosen` marks the model in use."""
    rows = [
        QualityRow(entry, model, fit, j, model == chosen)
        for j, (entry, chosen) in enumerate(
            zip(report.designs.characteristics, report.fitted.chosen, strict=True)
        )
        for model, fit in report.fitted.models.items()
    ]
    return Table(
        "Quality",
        f"Cross-validation over {len(report.designs.x)} designs; the model in use and all others.",
        QUALITY_COLUMNS,
        rows,
        title="Surrogates",
        sheet=SheetLayout(frozen="unit", single=True, first=("load_case", "characteristic", "unit")),
    )


def chosen_table(report: SurrogateReport) -> Table[QualityRow]:
    """The models in use, and beside each what all models reach."""
    table = quality_table(report)
    others = tuple(_q2_column(name, fit) for name, fit in report.fitted.models.items())
    return replace(table, rows=[r for r in table.rows if r.chosen], columns=(*table.columns, *others))


def _q2_column(model: str, fit: Judged) -> Column[QualityRow]:
    def q2(row: QualityRow) -> float:
        return float(fit.quality.q2[row.index])

    return Column(f"q2_{model}", f"Q2 {model}", q2, "0.0000", 12, csv=False)


def quality_document(report: SurrogateReport, model: str) -> dict[str, dict[str, Value]]:
    """Characteristic -> what cross-validation says of a model for it."""
    table = quality_table(report)
    rows = [r for r in table.rows if r.model == model]
    return dict(zip((r.id for r in rows), table_records(replace(table, rows=rows)), strict=True))


def left_out_predictions(report: SurrogateReport) -> FloatArray:
    """(n, m) of the chosen models, each design predicted without itself."""
    held = {name: judged.held.residual for name, judged in report.fitted.models.items()}
    return report.designs.y - report.fitted.of_chosen(held)


def left_out_sd(report: SurrogateReport) -> FloatArray:
    """(n, m) calibrated standard deviations of them."""
    held = {
        name: np.sqrt(judged.held.variance * judged.factors) for name, judged in report.fitted.models.items()
    }
    return report.fitted.of_chosen(held)


def predictions_frame(report: SurrogateReport) -> pd.DataFrame:
    """One row a design and characteristic: true value, left-out prediction, its standard deviation."""
    n, m = report.designs.y.shape
    return pd.DataFrame(
        {
            "design": np.repeat(np.arange(1, n + 1), m),
            "characteristic": np.tile([c.id for c in report.designs.characteristics], n),
            "true": report.designs.y.ravel(),
            "predicted": left_out_predictions(report).ravel(),
            "sd": left_out_sd(report).ravel(),
        }
    )


def matrix_frame(report: SurrogateReport, values: FloatArray) -> pd.DataFrame:
    """(d, m) values with the parameter's path in the first column, characteristics in the others."""
    ids = [c.id for c in report.designs.characteristics]
    return pd.DataFrame(values, index=list(report.space.paths), columns=ids).reset_index(names="parameter")


def matrix_document(report: SurrogateReport, values: FloatArray) -> dict[str, dict[str, float]]:
    """Characteristic -> parameter -> number."""
    paths = report.space.paths
    return {
        entry.id: dict(zip(paths, map(float, values[:, j]), strict=True))
        for j, entry in enumerate(report.designs.characteristics)
    }


def agreement_document(report: SurrogateReport) -> dict[str, dict[str, float]]:
    """Characteristic -> correlation, share of equal signs, error in percent of the largest entry."""
    a = report.agreement
    return {
        entry.id: {
            "correlation": float(a.correlation[j]),
            "same_sign": float(a.same_sign[j]),
            "error_percent": float(a.error[j]),
        }
        for j, entry in enumerate(report.designs.characteristics)
    }


@dataclass(frozen=True)
class MatrixRow:
    """One parameter of a matrix: percent of every characteristic."""

    path: str
    step: str
    percent: FloatArray


def matrix_table(report: SurrogateReport, name: str, remark: str, percent: FloatArray) -> Table[MatrixRow]:
    """A row a parameter, a column a characteristic. percent: (d, m)."""
    rows = [
        MatrixRow(v.path, f"{v.parameter.step:g} {v.unit}".removesuffix(" -"), values)
        for v, values in zip(report.space.variables, percent, strict=True)
    ]
    columns: tuple[Column[MatrixRow], ...] = (
        Column("parameter", "Path", lambda r: r.path, width=36),
        Column("step", "Step", lambda r: r.step, width=12),
        *(_matrix_column(j, entry) for j, entry in enumerate(report.designs.characteristics)),
    )
    layout = SheetLayout(frozen=columns[2].key, single=True)
    return Table(name, remark, columns, rows, title=f"{name} by surrogates", sheet=layout)


def _matrix_column(j: int, entry: Characteristic) -> Column[MatrixRow]:
    def value(row: MatrixRow) -> Value:
        return float(row.percent[j]) if np.isfinite(row.percent[j]) else None

    return Column(entry.id, f"{case_label(entry.load_case)}: {entry.label}", value, "0", 7.0)
