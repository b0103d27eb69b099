"""Handover of the answer: at the top of the study's folder what is to be used, shown and read by programs."""

from __future__ import annotations

from datetime import date
from pathlib import Path

from doe_kc.axle_file.write import write_axle
from doe_kc.characteristics import reduce_all
from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.correlation.assessment import Assessment
from doe_kc.correlation.result import Correlation
from doe_kc.ground.output import write_json
from doe_kc.measurement import Measurement
from doe_kc.report.overview import Overview
from doe_kc.report.overview_sheet import write_overview
from doe_kc.report.page.answer import files_there, write_answer_page
from doe_kc.report.page.links import link_pages
from doe_kc.report.page.simulation import write_simulation_page
from doe_kc.study import Study
from doe_kc.workflow.answer import summary_document
from doe_kc.workflow.write_correlation import AXLE, axle_note

SUMMARY = "summary.json"
PAGE = "index.html"
SHEET = "summary.pdf"


def write_answer(
    study: Study,
    correlation: Correlation,
    assessment: Assessment,
    record: AnswerRecord,
    measurement: Measurement,
) -> list[Path]:
    """axle.toml, summary.json, index.html and summary.pdf, the page as one A4 sheet, in the study's folder,
    and the page of the axle handed in; returns the paths. All pages of the study are linked with each other.

    RunError when the folder cannot be written.
    """
    axle = write_axle(
        correlation.axle, study.axle_path, study.out / AXLE, note=axle_note(correlation, assessment)
    )
    given = _write_given(study, correlation)
    document = summary_document(correlation, assessment, record, str(study.out / AXLE))
    summary = write_json(study.out / SUMMARY, document)
    overview = Overview(study.name, date.today().isoformat(), correlation, assessment, record)
    sheet = write_overview(study.out / SHEET, overview, files_there(study.out))
    page = write_answer_page(
        study.out / PAGE,
        overview,
        notes={
            "Axle": f"{AXLE}, from {study.axle_path.name}",
            "Measurement": measurement.manifest.name,
            "Run time": f"{record.seconds:.0f} s",
        },
        files=files_there(study.out),
    )
    link_pages(study.out)
    return [axle, summary, page, sheet, *given]


def _write_given(study: Study, correlation: Correlation) -> list[Path]:
    """The page of the axle handed in, where its solver gives curves."""
    curves = correlation.baseline.outcome.curves
    if curves is None:
        return []
    values, today = reduce_all(curves, study.windows), date.today().isoformat()
    path = study.out / "simulate" / "report.html"
    return [write_simulation_page(path, curves, values, study=study.name, date=today)]
