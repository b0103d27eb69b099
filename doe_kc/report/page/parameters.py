"""The parameters as a table with their place between the bounds (thesis, Appendix A)."""

from __future__ import annotations

import math
from dataclasses import replace

from markupsafe import Markup

from doe_kc.correlation.result import Correlation
from doe_kc.report.correlation_parameters import ParameterRow, parameter_table
from doe_kc.report.render.page import Section, render, table_html
from doe_kc.report.table import Column, PageCell

PARAMETERS_LEAD = (
    "Bars run from the baseline (tick) to the final value (dot) between lower and upper bound; whiskers are "
    "one standard deviation from the exact sensitivities. Hatched: not visible in these measurements."
)


def parameters_section(correlation: Correlation) -> Section:
    """One row a parameter, sortable and filterable."""
    table = parameter_table(correlation)
    table = replace(table, columns=(*table.columns, BOUNDS_COLUMN))
    return Section("Parameters", table_html(table, notice=render("hatch.svg")), PARAMETERS_LEAD)


def _bar(row: ParameterRow) -> Markup:
    """Nothing where there are no bounds."""
    return render("bounds.svg", r=row, isfinite=math.isfinite) if math.isfinite(row.place) else Markup("")


BOUNDS_COLUMN: Column[ParameterRow] = Column(
    "bar",
    None,
    lambda r: abs(r.place - r.start),
    csv=False,
    page=PageCell("Place between lower and upper bound", text=_bar, order=lambda r: abs(r.place - r.start)),
)
