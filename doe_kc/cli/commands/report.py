"""`doe-kc report`: rebuilds from the store what the last correlation or run handed over."""

from __future__ import annotations

import typer

from doe_kc.cli._app import app
from doe_kc.cli.study_options import StudyOptions, takes_study
from doe_kc.ground.output import write_json
from doe_kc.workflow.answer import answer_lines
from doe_kc.workflow.compare import compare_model, write_comparison
from doe_kc.workflow.measure import study_records
from doe_kc.workflow.reload_correlation import recall
from doe_kc.workflow.write_answer import write_answer
from doe_kc.workflow.write_correlation import AXLE, correlation_document, correlation_lines, write_correlation

NO_RUN = (
    "No run is stored, only a correlation: axle.toml, index.html and summary.json in {out} were not rebuilt; "
    "doe-kc run writes them."
)


@app.command("report")
@takes_study
def report(study_options: StudyOptions) -> None:
    """Rebuild the last correlation's results, and the answer of its run, with the study's present weights.

    No design is solved again. After doe-kc correlate there is no run: the answer at the top of out is left.
    """
    found = study_options.read()
    reduced = study_records(found)
    folder = found.out / "correlate"
    recalled = recall(found, reduced, folder)
    correlation, assessment, answer = recalled.correlation, recalled.assessment, recalled.answer
    records = reduced.measurement if reduced is not None else None
    written = write_correlation(
        found, correlation, records, folder, assessment=assessment, workers=study_options.workers
    )
    lines = correlation_lines(correlation, assessment)
    if answer is not None and records is not None:
        curves = correlation.best.outcome.curves
        if curves is not None:
            comparison = compare_model(found, curves, records)
            written += write_comparison(
                comparison, found.out / "compare", workers=study_options.workers, pictures=found.pictures
            )
        written += write_answer(found, correlation, assessment, answer, records)
        lines = [*answer_lines(assessment, answer), *lines[1:], f"The answer: {found.out / AXLE}"]
    else:
        lines.append(NO_RUN.format(out=found.out))
    if study_options.json is not None:
        write_json(study_options.json, correlation_document(correlation, folder / "axle.toml", assessment))
    for line in lines:
        typer.echo(line)
    typer.echo(f"{len(written)} files under {found.out}", err=True)
