"""The report page of a correlation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from doe_kc.correlation.assessment import STATUS_LABELS, Assessment, assess
from doe_kc.correlation.result import Correlation
from doe_kc.measurement import Measurement
from doe_kc.reporting.correlation_parameters import remark_sentences
from doe_kc.reporting.correlation_summary import summary
from doe_kc.reporting.page.characteristics import characteristics_section
from doe_kc.reporting.page.convergence import convergence_section
from doe_kc.reporting.page.curves import curves_section
from doe_kc.reporting.page.parameters import parameters_section
from doe_kc.reporting.page.section import Section, render, write_page


def correlation_sections(
    found: Correlation,
    measurement: Measurement | None,
    *,
    notes: Mapping[str, str] | None = None,
    assessment: Assessment | None = None,
) -> list[Section]:
    """Summary, Characteristics, Curves, Convergence, Parameters. notes: further lines of the summary."""
    sections = [_summary(found, notes or {}, assessment or assess(found)), characteristics_section(found)]
    sections += curves_section(found, measurement)
    return [*sections, convergence_section(found), parameters_section(found)]


def write_correlation_page(
    path: Path,
    found: Correlation,
    measurement: Measurement | None,
    *,
    study: str,
    date: str,
    notes: Mapping[str, str] | None = None,
    assessment: Assessment | None = None,
) -> Path:
    """Write the page; RunError when it cannot be written."""
    sections = correlation_sections(found, measurement, notes=notes, assessment=assessment)
    return write_page(path, f"Correlation: {study}", sections, subtitle=date)


def _summary(found: Correlation, notes: Mapping[str, str], assessment: Assessment) -> Section:
    html = render(
        "summary.html",
        lines=summary(found, assessment),
        status=assessment.status,
        status_label=STATUS_LABELS[assessment.status],
        feasible=found.feasible,
        mean=found.mean_improvement,
        rating=found.rating,
        evaluations=len(found.run.evaluated),
        remarks=remark_sentences(found),
        notes=notes,
    )
    return Section("Summary", html)
