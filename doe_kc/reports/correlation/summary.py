"""The outcome of a correlation in a few lines: the same in terminal, workbook and page."""

from __future__ import annotations

import math

from doe_kc.correlation.assessment import Assessment, assess
from doe_kc.correlation.result import Correlation
from doe_kc.reports.correlation.evaluations import history


def summary(correlation: Correlation, assessment: Assessment | None = None) -> dict[str, str]:
    """Title -> text, the most important first. assessment: by default the correlation's own."""
    verdict = assessment or assess(correlation)
    past = history(correlation)
    violated = [
        e.target.entry.id
        for e in correlation.improvements
        if e.target.constraint is not None and not e.inside
    ]
    lines = {
        "Status": verdict.line,
        "Rating": f"{correlation.rating:.6g} (baseline {correlation.baseline_rating:.6g}; "
        "0 = every target met exactly)",
        "Constraints": "all met" if correlation.feasible else f"violated: {', '.join(violated)}",
        "Mean improvement": _improvement(correlation),
        "Method": correlation.method,
        "Evaluations": _evaluations(correlation, int(past.failed.sum())),
        "First feasible": f"evaluation {past.first_feasible}" if past.first_feasible else "never",
        "Stopped": correlation.run.stopped,
        "Time": f"{correlation.seconds:.1f} s",
    }
    if correlation.twin is not None:
        lines["Twin"] = correlation.twin.line
    return lines | {
        f"Beforehand{_number(i, len(correlation.steps))}": s for i, s in enumerate(correlation.steps)
    }


def _improvement(correlation: Correlation) -> str:
    mean, exact = correlation.mean_improvement, correlation.exact_model_improvement
    if not math.isfinite(mean):
        return "none counts: every baseline is within three standard deviations of its target"
    words = f"{mean:.1f} % over {sum(e.counts for e in correlation.improvements)} characteristics"
    noise = f"; an exact model would show {exact:.0f} % on average, by the noise of the targets"
    return words + (noise if exact < 100.0 else "")


def _evaluations(correlation: Correlation, failed: int) -> str:
    words = (
        f"{len(correlation.run.evaluated)} of the true solver, the best is number {correlation.run.best + 1}"
    )
    return words + (f"; {failed} had no equilibrium" if failed else "")


def _number(i: int, count: int) -> str:
    return f" {i + 1}" if count > 1 else ""
