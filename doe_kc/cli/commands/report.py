"""`doe-kc report`: rebuilds from the store what the last correlation or run handed over."""

from __future__ import annotations

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import StudyOptions, takes_study
from doe_kc.ground.output import write_json
from doe_kc.workflow.rebuild import rebuild, write_rebuilt
from doe_kc.workflow.write_correlation import AXLE, correlation_document

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
    study = study_options.read()
    rebuilt = rebuild(study)
    written = write_rebuilt(study, rebuilt, workers=study_options.workers)
    correlation, assessment = rebuilt.recalled.correlation, rebuilt.recalled.assessment
    if study_options.json is not None:
        document = correlation_document(correlation, study.out / "correlate" / AXLE, assessment)
        write_json(study_options.json, document)
    for line in rebuilt.lines:
        typer.echo(line)
    typer.echo(f"The answer: {study.out / AXLE}" if rebuilt.is_run else NO_RUN.format(out=study.out))
    typer.echo(f"{len(written)} files under {study.out}", err=True)
