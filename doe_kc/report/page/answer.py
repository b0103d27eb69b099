"""The first page of a study: the answer, the characteristics, and where everything else is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from doe_kc.correlation.assessment import STATUS_LABELS, Assessment
from doe_kc.correlation.result import Correlation
from doe_kc.report.page.axle import axle_section
from doe_kc.report.page.correlation import characteristics_section
from doe_kc.report.render.page import Section, render, write_page

RESULT_FILES: Mapping[str, str] = {
    "discover/report.html": "what the model lacks, how that was found, what to test next",
    "discover/discovery.xlsx": "the same as a workbook",
    "correlate/report.html": "the correlation: curves, convergence, parameters with their uncertainty",
    "correlate/correlation.xlsx": "the same as a workbook, with the rating as live formulas",
    "influence/influence.xlsx": "parameter-influence matrix of the axle as it was handed in",
    "influence/influence_heat_map.png": "the same as a picture",
    "compare/characteristics.csv": "the axle handed over beside the records",
    "reduce/characteristics.csv": "targets from the records, with their standard deviations",
}
"""File under the study's folder -> what is in it."""


def write_answer_page(
    path: Path,
    correlation: Correlation,
    assessment: Assessment,
    *,
    study: str,
    date: str,
    lines: Sequence[str],
    notes: Mapping[str, str],
    folder: Path,
) -> Path:
    """Write the page; RunError when it cannot be written. lines: further sentences on the answer. folder: in
    which the files are that it links to, those that are there."""
    html = render(
        "answer.html",
        status=assessment.status,
        status_label=STATUS_LABELS[assessment.status],
        reasons=assessment.reasons,
        lines=lines,
        mean=correlation.mean_improvement,
        rating=correlation.rating,
        baseline_rating=correlation.baseline_rating,
        notes=notes,
    )
    places = {name: words for name, words in RESULT_FILES.items() if (folder / name).is_file()}
    sections = [
        Section("Answer", html),
        characteristics_section(correlation),
        axle_section(correlation),
        Section("Everything else", render("answer_files.html", places=places)),
    ]
    return write_page(path, study, sections, subtitle=date)
