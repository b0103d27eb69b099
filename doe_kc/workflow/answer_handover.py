"""Handover of the answer: at the top of the study's folder what is to be used, shown and read by programs."""

from __future__ import annotations

from datetime import date
from pathlib import Path

from doe_kc.axle.write import write_axle
from doe_kc.measurement import Measurement
from doe_kc.output import write_json
from doe_kc.reporting.page.answer import write_answer_page
from doe_kc.study import Study
from doe_kc.workflow.answer import Answer, answer_lines, summary_document
from doe_kc.workflow.handover import axle_note

AXLE = "axle.toml"
SUMMARY = "summary.json"
PAGE = "index.html"


def write_answer(study: Study, answer: Answer, measurement: Measurement, seconds: float) -> list[Path]:
    """axle.toml, summary.json and index.html in the study's folder; returns the paths.

    seconds: of the whole run. RunError when the folder cannot be written.
    """
    correlation, assessment = answer.correlation, answer.assessment
    axle = write_axle(
        correlation.axle, study.axle_path, study.out / AXLE, note=axle_note(correlation, assessment)
    )
    summary = write_json(study.out / SUMMARY, summary_document(answer, str(study.out / AXLE), seconds))
    page = write_answer_page(
        study.out / PAGE,
        correlation,
        assessment,
        study=study.name,
        date=date.today().isoformat(),
        lines=answer_lines(answer)[1:],
        notes={
            "Axle": f"{AXLE}, from {study.axle_path.name}",
            "Measurement": measurement.manifest.name,
            "Run time": f"{seconds:.0f} s",
        },
        folder=study.out,
    )
    return [axle, summary, page]
