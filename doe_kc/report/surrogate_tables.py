"""Tables of a surrogate study: quality, predictions, influence, shares."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.report import SurrogateReport


def judged_document(report: SurrogateReport, model: str) -> dict[str, dict[str, Any]]:
    """Characteristic -> what cross-validation says of a model for it."""
    judged = report.fitted.models[model]
    q = judged.quality
    return {
        entry.id: {
            "q2": q.q2[j],
            "rmse": q.rmse[j],
            "unit": entry.unit,
            "coverage": q.coverage[j],
            "calibrated_coverage": judged.covered[j],
            "sharpness": q.sharpness[j],
            "variance_factor": judged.factors[j],
        }
        for j, entry in enumerate(report.designs.characteristics)
    }


def quality_frame(report: SurrogateReport) -> pd.DataFrame:
    """One row a characteristic and model; `chosen` marks the model in use."""
    chosen = {
        c.id: name for c, name in zip(report.designs.characteristics, report.fitted.chosen, strict=True)
    }
    rows = [
        {"characteristic": entry, "model": model, "chosen": chosen[entry] == model, **values}
        for model in report.fitted.models
        for entry, values in judged_document(report, model).items()
    ]
    order = {c.id: j for j, c in enumerate(report.designs.characteristics)}
    frame = pd.DataFrame(rows)
    return frame.sort_values("characteristic", key=lambda s: s.map(order), kind="stable", ignore_index=True)


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
