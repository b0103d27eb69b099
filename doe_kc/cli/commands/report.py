"""`doe-kc report`: rebuilds workbook, tables, pictures and page of the last correlation from the store."""

from __future__ import annotations

import typer

from doe_kc.cli._app import app
from doe_kc.cli.given import Given, takes_study
from doe_kc.output import write_json
from doe_kc.workflow.handover import correlation_document, correlation_lines, write_correlation
from doe_kc.workflow.measure import study_records
from doe_kc.workflow.recall import recall


@app.command("report")
@takes_study
def report(given: Given) -> None:
    """Rebuild the results of the last correlation with the study's present weights; nothing is solved."""
    found = given.read()
    reduced = study_records(found)
    folder = found.out / "correlate"
    recalled = recall(found, reduced, folder)
    correlation, assessment = recalled.correlation, recalled.assessment
    records = reduced.measurement if reduced is not None else None
    written = write_correlation(
        found, correlation, records, folder, assessment=assessment, workers=given.workers
    )
    if given.json is not None:
        write_json(given.json, correlation_document(correlation, folder / "axle.toml", assessment))
    for line in correlation_lines(correlation, assessment):
        typer.echo(line)
    typer.echo(f"{len(written)} files in {folder}", err=True)
