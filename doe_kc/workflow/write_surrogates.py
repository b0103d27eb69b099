"""What fitted surrogates leave to the engineer: workbook, tables, figures, JSON and terminal text."""

from __future__ import annotations

import math
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np

from doe_kc.ground.output import write_csv
from doe_kc.report import surrogate_tables as tables
from doe_kc.report.render.csv import table_frame
from doe_kc.report.render.terminal import table_lines
from doe_kc.report.surrogate_evaluator import write_evaluator
from doe_kc.report.surrogate_figures import write_surrogate_figures
from doe_kc.report.surrogate_workbook import write_surrogate_workbook
from doe_kc.study import Study
from doe_kc.surrogates.report import SurrogateReport
from doe_kc.surrogates.saved import save_surrogate
from doe_kc.workflow.predict import saved_surrogate


def write_surrogates(
    study: Study, report: SurrogateReport, folder: Path, *, workers: int | None = None
) -> list[Path]:
    """surrogates.xlsx, surrogate.npz for `predict`, CSV tables (quality, predictions, influence, shares) and
    figures; their paths."""
    book = write_surrogate_workbook(
        folder / "surrogates.xlsx", report, study=study.name, date=date.today().isoformat()
    )
    frames = {
        "quality": table_frame(tables.quality_table(report)),
        "predictions": tables.predictions_frame(report),
        "influence": tables.matrix_frame(report, report.changes),
        "shares": tables.matrix_frame(report, report.shares),
    }
    csv = [write_csv(folder / f"{name}.csv", frame) for name, frame in frames.items()]
    pictures = write_surrogate_figures(
        report, folder, study=study.name, workers=workers, pictures=study.pictures
    )
    surrogate = saved_surrogate(report, study=study.name)
    kept = [save_surrogate(folder / "surrogate.npz", surrogate)]
    if "quadratic" not in report.fitted.chosen:  # which has no formula of few lines
        kept += write_evaluator(folder / "evaluator", surrogate)
    return [book, *kept, *csv, *pictures]


def surrogates_document(report: SurrogateReport) -> dict[str, Any]:
    """`{"designs", "failed", "elsewhere", "chosen": {characteristic: model}, "models": {model: {"seconds",
    "characteristics": {characteristic: {"q2", "rmse", "unit", "coverage", "calibrated_coverage",
    "calibrated_low", "calibrated_high", "sharpness"}}}}, "skipped": {model: reason}, "influence":
    {characteristic: {parameter: change}}, "shares", "agreement"}`.
    """
    ids = [c.id for c in report.designs.characteristics]
    return {
        "designs": len(report.designs.x),
        "failed": report.designs.failed,
        "elsewhere": report.designs.elsewhere,
        "chosen": dict(zip(ids, report.fitted.chosen, strict=True)),
        "models": {
            name: {"seconds": judged.seconds, "characteristics": tables.quality_document(report, name)}
            for name, judged in report.fitted.models.items()
        },
        "skipped": report.fitted.skipped,
        "influence": tables.matrix_document(report, report.changes),
        "shares": tables.matrix_document(report, report.shares),
        "agreement": tables.agreement_document(report),
    }


def surrogate_lines(report: SurrogateReport) -> list[str]:
    """For a terminal: the chosen model of every characteristic and its quality, then what was left out."""
    lines = table_lines(tables.chosen_table(report))
    lines += [f"{name}: {_average(report, name)}" for name in report.fitted.models]
    lines += [f"{name} left out: {reason}" for name, reason in report.fitted.skipped.items()]
    r = report.agreement.correlation
    if np.isfinite(r).any():
        median, least = np.nanmedian(r), np.nanmin(r)
        lines.append(
            "influence at the unchanged axle against one at a time: correlation "
            f"{median:.3f} in the median, {least:.3f} at least"
        )
    lines.append(
        f"{len(report.designs.x)} designs, {report.designs.failed} failed and {report.designs.elsewhere} of "
        "other variables or bounds left out"
    )
    return lines


def _average(report: SurrogateReport, name: str) -> str:
    judged = report.fitted.models[name]
    q2 = judged.quality.q2
    used = sum(n == name for n in report.fitted.chosen)
    mean, worst = (float(f(q2)) if np.isfinite(q2).any() else math.nan for f in (np.nanmean, np.nanmin))
    return (
        f"Q2 {mean:.4f} in the mean, {worst:.4f} at worst, one fit {judged.seconds:.2f} s, "
        f"used for {used} of {len(report.fitted.chosen)}"
    )
