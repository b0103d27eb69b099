"""The report page of a correlation: its characteristics (thesis, Appendix D), parameters (Appendix A)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from markupsafe import Markup

from doe_kc.correlation.assessment import Assessment, assess
from doe_kc.correlation.result import Correlation
from doe_kc.correlation.status import STATUS_LABELS
from doe_kc.measurement import Measurement
from doe_kc.reports.comparison.car_table import cars_beside
from doe_kc.reports.correlation.characteristics import CharacteristicRow, characteristic_table
from doe_kc.reports.correlation.convergence import threshold
from doe_kc.reports.correlation.dna import DNA_REACH
from doe_kc.reports.correlation.evaluations import history
from doe_kc.reports.correlation.parameters import ParameterRow, parameter_table, remark_sentences
from doe_kc.reports.correlation.summary import summary
from doe_kc.reports.correlation.twin_tables import TWIN_REMARK, twin_table
from doe_kc.reports.drawing import style
from doe_kc.reports.page.axle import axle_section
from doe_kc.reports.page.cars import cars_section
from doe_kc.reports.page.curves import curves_section
from doe_kc.reports.page.glossary import glossary_section
from doe_kc.reports.render.page import Section, embedded, render, significant, table_html, write_page
from doe_kc.reports.table import Column, PageCell

BAR_WIDTH = 230
"""Units across a bar's drawing."""
CHARACTERISTICS_LEAD = (
    "Values normalised to their target: 1 is the target, the grey band the constraint interval (dotted where "
    "it is no constraint); arrows point to values beyond the axis. 100 % = target met, 0 % = as far off as "
    "the baseline. Near zero the measure of the interval, sqrt(target² + 0.005), stands in for the target."
)


def characteristics_section(correlation: Correlation) -> Section:
    """One row a characteristic, sortable and filterable."""
    table = characteristic_table(correlation)
    table = replace(table, columns=(*table.columns, _bar_column()))
    html = table_html(table, notice=render("characteristics_key.html"))
    return Section("Characteristics", html, CHARACTERISTICS_LEAD)


def place(normalized: float) -> float:
    """Unit across the drawing of a normalised value, cut off at its ends."""
    share = (normalized - 1.0 + DNA_REACH) / (2.0 * DNA_REACH)
    return 10.0 + min(max(share, 0.0), 1.0) * (BAR_WIDTH - 20.0)


def bar(row: CharacteristicRow) -> Markup:
    """The drawing of one row."""
    entry = row.entry
    low, high = sorted(place(row.normalized(v)) for v in row.interval)
    values: dict[str, Any] = {"low": low, "high": high, "target": place(1.0), "width": BAR_WIDTH}
    for name, value in (("baseline", entry.baseline), ("final", entry.final)):
        at = row.normalized(value)
        known = math.isfinite(at)
        values[name] = {
            "x": place(at) if known else place(1.0),
            "known": known,
            "beyond": 0 if not known or abs(at - 1.0) <= DNA_REACH else 1 if at > 1.0 else -1,
        }
    words = (
        f"{row.load_case}, {row.label}: target {significant(entry.target.value)}, baseline "
        f"{significant(entry.baseline)}, final {significant(entry.final)} {row.unit}; interval "
        f"{significant(row.interval[0])} to {significant(row.interval[1])}"
    )
    return render("bar.svg", **values, row=row, words=words)


def _bar_column() -> Column[CharacteristicRow]:
    """Baseline and final value beside the interval, sorted by the distance from the target."""
    scale = render("bar_scale.html", reach=DNA_REACH, width=BAR_WIDTH, place=place)
    cell = PageCell(scale, text=bar, order=_off_target)
    return Column("bar", None, _off_target, csv=False, page=cell)


def _off_target(row: CharacteristicRow) -> float:
    return abs(row.normalized(row.entry.final) - 1.0)


PARAMETERS_LEAD = (
    "Bars run from the baseline (tick) to the final value (dot) between lower and upper bound; whiskers are "
    "one standard deviation from the exact sensitivities. Hatched: not visible in these measurements."
)


def parameters_section(correlation: Correlation) -> Section:
    """One row a parameter, sortable and filterable."""
    table = parameter_table(correlation)
    table = replace(table, columns=(*table.columns, BOUNDS_COLUMN))
    return Section("Parameters", table_html(table, notice=render("hatch.svg")), PARAMETERS_LEAD)


def _bounds_bar(row: ParameterRow) -> Markup:
    """Nothing where there are no bounds."""
    return render("bounds.svg", r=row, isfinite=math.isfinite) if math.isfinite(row.place) else Markup("")


BOUNDS_COLUMN: Column[ParameterRow] = Column(
    "bar",
    None,
    lambda r: abs(r.place - r.start),
    csv=False,
    page=PageCell(
        "Place between lower and upper bound", text=_bounds_bar, order=lambda r: abs(r.place - r.start)
    ),
)


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


def twin_section(correlation: Correlation) -> list[Section]:
    """Where an outside model and its twin disagree; none without a twin."""
    agreement = correlation.twin
    if agreement is None:
        return []
    return [Section("Twin", table_html(twin_table(agreement)), f"{agreement.line} {TWIN_REMARK}")]


def correlation_sections(
    correlation: Correlation,
    measurement: Measurement | None,
    *,
    notes: Mapping[str, str] | None = None,
    assessment: Assessment | None = None,
) -> list[Section]:
    """Summary, Characteristics, Cars where there are several, Curves, Twin where an outside model has one,
    Convergence, Parameters, Axle.

    notes: further lines of the summary.
    """
    sections = [
        _summary(correlation, notes or {}, assessment or assess(correlation)),
        characteristics_section(correlation),
    ]
    sections += cars_section(cars_beside(correlation, measurement))
    sections += curves_section(correlation, measurement)
    sections += twin_section(correlation)
    return [
        *sections,
        convergence_section(correlation),
        parameters_section(correlation),
        axle_section(correlation),
    ]


def write_correlation_page(
    path: Path,
    correlation: Correlation,
    measurement: Measurement | None,
    *,
    study: str,
    date: str,
    notes: Mapping[str, str] | None = None,
    assessment: Assessment | None = None,
) -> Path:
    """Write the page; RunError when it cannot be written."""
    sections = correlation_sections(correlation, measurement, notes=notes, assessment=assessment)
    terms = glossary_section(*CORRELATION_TERMS)
    return write_page(
        path,
        f"Correlation: {study}",
        [*sections, terms],
        subtitle=date,
        labels=correlation.problem.axle.labels,
    )


CORRELATION_TERMS = ("noise", "± uncertainty", "interval", "rating", "improvement", "not visible", "prior")


def _summary(correlation: Correlation, notes: Mapping[str, str], assessment: Assessment) -> Section:
    html = render(
        "summary.html",
        lines=summary(correlation, assessment),
        status=assessment.status,
        status_label=STATUS_LABELS[assessment.status],
        feasible=correlation.feasible,
        mean=correlation.mean_improvement,
        rating=correlation.rating,
        evaluations=len(correlation.run.evaluated),
        remarks=remark_sentences(correlation),
        notes=notes,
    )
    return Section("Summary", html)
