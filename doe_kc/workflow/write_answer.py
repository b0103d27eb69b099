"""Handover of the answer: at the top of the study's folder what is to be used, shown and read by programs."""

from __future__ import annotations

from datetime import date
from pathlib import Path

from doe_kc.axle_file.write import write_axle
from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.correlation.assessment import Assessment
from doe_kc.correlation.result import Correlation
from doe_kc.ground.output import write_json
from doe_kc.measurement import Measurement
from doe_kc.report.page.answer import write_answer_page
from doe_kc.study import Study
from doe_kc.workflow.answer import answer_lines, summary_document
from doe_kc.workflow.write_correlation import AXLE, axle_note

SUMMARY = "summary.json"
PAGE = "index.html"


def write_answer(
    study: Study,
    correlation: Correlation,
    assessment: Assessment,
    record: AnswerRecord,
    measurement: Measurement,
) -> list[Path]:
    """axle.toml, summary.json and index.html in the study's folder; returns the paths.

    RunError when the folder cannot be written.
    """
    axle = write_axle(
        correlation.axle, study.axle_path, study.out / AXLE, note=axle_note(correlation, assessment)
    )
    document = summary_document(correlation, assessment, record, str(study.out / AXLE))
    summary = write_json(study.out / SUMMARY, document)
    page = write_answer_page(
        study.out / PAGE,
        correlation,
        assessment,
        study=study.name,
        date=date.today().isoformat(),
        lines=answer_lines(assessment, record)[1:],
        notes={
            "Axle": f"{AXLE}, from {study.axle_path.name}",
            "Measurement": measurement.manifest.name,
            "Run time": f"{record.seconds:.0f} s",
        },
        folder=study.out,
    )
    return [axle, summary, page]
