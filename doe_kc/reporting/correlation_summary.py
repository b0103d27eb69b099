"""The outcome of a correlation in a few lines: the same in terminal, workbook and page."""

from __future__ import annotations

import math

from doe_kc.correlation.assessment import Assessment, assess
from doe_kc.correlation.result import Correlation
from doe_kc.reporting.correlation_evaluations import history


def summary(found: Correlation, assessment: Assessment | None = None) -> dict[str, str]:
    """Title -> text, the most important first. assessment: by default the correlation's own."""
    verdict = assessment or assess(found)
    past = history(found)
    counted = sum(e.counts for e in found.improvements)
    mean = found.mean_improvement
    violated = [
        e.target.entry.id for e in found.improvements if e.target.constraint is not None and not e.inside
    ]
    lines = {
        "Status": verdict.line,
        "Rating": f"{found.rating:.6g} (baseline {found.baseline_rating:.6g}; 0 = every target met exactly)",
        "Constraints": "all met" if found.feasible else f"violated: {', '.join(violated)}",
        "Mean improvement": f"{mean:.1f} % over {counted} characteristics"
        if math.isfinite(mean)
        else "none counts: every baseline is within three standard deviations of its target",
        "Method": found.method,
        "Evaluations": _evaluations(found, int(past.failed.sum())),
        "First feasible": f"evaluation {past.first_feasible}" if past.first_feasible else "never",
        "Stopped": found.run.stopped,
        "Time": f"{found.seconds:.1f} s",
    }
    return lines | {f"Beforehand{_number(i, len(found.steps))}": s for i, s in enumerate(found.steps)}


def _evaluations(found: Correlation, failed: int) -> str:
    words = f"{len(found.run.evaluated)} of the true solver, the best is number {found.run.best + 1}"
    return words + (f"; {failed} had no equilibrium" if failed else "")


def _number(i: int, count: int) -> str:
    return f" {i + 1}" if count > 1 else ""
