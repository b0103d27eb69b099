"""The parameters as a table with their place between the bounds (thesis, Appendix A)."""

from __future__ import annotations

import math

from doe_kc.correlation.result import Correlation
from doe_kc.ground.numbers import with_sd
from doe_kc.report.correlation_parameters import ParameterRow, parameter_rows
from doe_kc.report.page.section import Section, render

PARAMETERS_LEAD = (
    "Bars run from the baseline (tick) to the final value (dot) between lower and upper bound; whiskers are "
    "one standard deviation from the exact sensitivities. Hatched: not visible in these measurements."
)


def parameters_section(correlation: Correlation) -> Section:
    """One row a parameter, sortable and filterable."""
    rows = [{"row": r, "text": with_sd(r.final, r.sd), "tags": _tags(r)} for r in parameter_rows(correlation)]
    return Section(
        "Parameters", render("parameters.html", rows=rows, isfinite=math.isfinite), PARAMETERS_LEAD
    )


def _tags(row: ParameterRow) -> str:
    tags = {
        "bound": bool(row.at_bound),
        "unseen": row.visible is False,
        "visible": row.visible is not False,
        "variable": row.role == "variable",
    }
    return " ".join(k for k, on in tags.items() if on)
