"""The merit of the search over the evaluations, to hover over."""

from __future__ import annotations

from doe_kc.correlation.result import Correlation
from doe_kc.report import style
from doe_kc.report.correlation_convergence import threshold
from doe_kc.report.correlation_evaluations import history
from doe_kc.report.render.page import Section, embedded, render

CONVERGENCE_LEAD = (
    "Minus what the search maximizes on a symmetric logarithmic axis: 0 = every target met exactly. Open "
    "marks violate a constraint; crosses on top had no equilibrium."
)


def convergence_section(correlation: Correlation) -> Section:
    """Chart of every evaluation and what was expected of it."""
    past = history(correlation)
    data = {
        "number": past.number,
        "origin": list(past.origin),
        "rating": past.rating,
        "best": past.best,
        "feasible": past.feasible,
        "failed": past.failed,
        "predicted": past.predicted,
        "sd": past.sd,
        "reason": [e.outcome.reason for e in correlation.run.evaluated],
        "origins": [
            {"name": name, "colour": style.COLOUR_CYCLE[k % len(style.COLOUR_CYCLE)]}
            for k, name in enumerate(past.origins)
        ],
        "linear": threshold(past),
        "first": past.first_feasible,
        "chosen": correlation.run.best + 1,
    }
    return Section("Convergence", render("convergence.html", data=embedded(data)), CONVERGENCE_LEAD)
