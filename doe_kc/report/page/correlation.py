"""The report page of a correlation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from doe_kc.correlation.assessment import STATUS_LABELS, Assessment, assess
from doe_kc.correlation.result import Correlation
from doe_kc.measurement import Measurement
from doe_kc.report.correlation_parameters import remark_sentences
from doe_kc.report.correlation_summary import summary
from doe_kc.report.page.characteristics import characteristics_section
from doe_kc.report.page.convergence import convergence_section
from doe_kc.report.page.curves import curves_section
from doe_kc.report.page.parameters import parameters_section
from doe_kc.report.render.page import Section, render, write_page


def correlation_sections(
    correlation: Correlation,
    measurement: Measurement | None,
    *,
    notes: Mapping[str, str] | None = None,
    assessment: Assessment | None = None,
) -> list[Section]:
    """Summary, Characteristics, Curves, Convergence, Parameters. notes: further lines of the summary."""
    sections = [
        _summary(correlation, notes or {}, assessment or assess(correlation)),
        characteristics_section(correlation),
    ]
    sections += curves_section(correlation, measurement)
    return [*sections, convergence_section(correlation), parameters_section(correlation)]


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
    return write_page(path, f"Correlation: {study}", sections, subtitle=date)


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
