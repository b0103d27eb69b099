"""The first page of a study: what is read in a minute, on one sheet of paper, and links to the rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from markupsafe import Markup

from doe_kc.reports.answer.overview import AGREEMENT_LEAD, Overview, agreement_table, change_table
from doe_kc.reports.page.axle import strip_section
from doe_kc.reports.page.glossary import glossary_section
from doe_kc.reports.render.page import Section, render, significant, table_html, write_page
from doe_kc.reports.table import Column, PageCell, PageLayout, Table, ink_on

RESULT_FILES: Mapping[str, str] = {
    "axle.toml": "the axle to use",
    "summary.pdf": "this page to print or mail",
    "discover/report.html": "what the model lacks, how that was found, what to test next",
    "correlate/report.html": "characteristics, curves, parameters with their uncertainty",
    "compare/report.html": "the axle to use beside the records, load case by load case",
    "influence/report.html": "which parameter moves which characteristic",
    "tolerance/report.html": "what production makes of the axle as it was handed in",
    "reduce/report.html": "the rig records: curves, noise, targets",
    "simulate/report.html": "the axle as it was handed in",
    "discover/discovery.xlsx": "what the model lacks, as a workbook",
    "correlate/correlation.xlsx": "the correlation as a workbook, the rating as live formulas",
    "influence/influence.xlsx": "the influences as a workbook",
    "summary.json": "the answer for programs",
}
"""File under the study's folder -> what is in it."""


ANSWER_TERMS = ("times the noise", "± uncertainty", "sure (98 %)", "interval", "rating", "improvement")


@dataclass(frozen=True)
class ResultFile:
    """name: path under the study's folder."""

    name: str
    words: str


def _link(file: ResultFile) -> Markup:
    return Markup('<a href="{0}">{0}</a>').format(file.name)


FILE_COLUMNS: tuple[Column[ResultFile], ...] = (
    Column("name", "File", lambda f: f.name, page=PageCell(style="first", text=_link)),
    Column("words", "What is in it", lambda f: f.words, page=PageCell(style="wide")),
)


def files_there(folder: Path) -> dict[str, str]:
    """Those of the result files that there are."""
    return {name: words for name, words in RESULT_FILES.items() if (folder / name).is_file()}


def write_answer_page(
    path: Path, overview: Overview, *, notes: Mapping[str, str], files: Mapping[str, str]
) -> Path:
    """Write the page; RunError when it cannot be written. files: to link to, and what is in each."""
    return write_page(
        path,
        overview.study,
        answer_sections(overview, notes, files),
        subtitle=overview.date,
        paper="portrait",
        labels=overview.correlation.problem.axle.labels,
    )


def answer_sections(overview: Overview, notes: Mapping[str, str], files: Mapping[str, str]) -> list[Section]:
    """Answer, what was lacking, agreement, numbers, axle, files; folded: figures and words of the method."""
    layout = PageLayout[ResultFile]("files-table", "Pages and files")
    rows = [ResultFile(name, words) for name, words in files.items()]
    changes, agreement = change_table(overview), agreement_table(overview)
    return [
        Section("Answer", render("answer.html", overview=overview, ink=ink_on(overview.status_fill))),
        Section("What the model lacked", render("answer_lacked.html", overview=overview)),
        Section(
            "Agreement",
            table_html(agreement) if agreement.rows else Markup("<p>Not known of the axle handed over.</p>"),
            AGREEMENT_LEAD if agreement.rows else "",
        ),
        Section("Numbers to act on", table_html(changes) if changes.rows else Markup(), changes.remark),
        strip_section(overview.view),
        Section("Where to find the rest", table_html(Table("Files", "", FILE_COLUMNS, rows, page=layout))),
        Section("More figures", _more(overview, notes), folded="Figures of the method, and what was read"),
        glossary_section(*ANSWER_TERMS),
    ]


def _more(overview: Overview, notes: Mapping[str, str]) -> Markup:
    correlation, gap = overview.correlation, overview.record.gap
    mean, before = correlation.mean_improvement, significant(correlation.baseline_rating)
    figures = {
        "Rating": f"{before} → {significant(correlation.rating)}, 0 is best",
        "Mean improvement": f"{mean:.1f} %" if math.isfinite(mean) else "none counts",
    }
    if gap is not None and gap.tuned is not None:
        figures["Deviation"] = (
            f"{gap.nominal:.2f} × the noise as handed in → {gap.tuned:.2f} re-tuned without an effect → "
            f"{gap.final:.2f} now; {gap.noise_floor:.2f} is noise"
        )
    return render("answer_more.html", notes={**figures, **notes})
