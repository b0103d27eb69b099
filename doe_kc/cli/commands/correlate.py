"""`doe-kc correlate`: tunes the axle to the records and hands it over."""

from __future__ import annotations

from typing import Annotated, Unpack

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import SchedulerOption, StudyOptions, takes_study
from doe_kc.cli.progress import correlation_bar
from doe_kc.correlation.assessment import Assessment, assess
from doe_kc.correlation.result import Correlation
from doe_kc.ground.errors import RunError
from doe_kc.ground.output import write_json
from doe_kc.study import Study
from doe_kc.workflow.correlate import CorrelationChoices
from doe_kc.workflow.correlate import correlate as run_correlation
from doe_kc.workflow.measure import Reduced, study_records
from doe_kc.workflow.rebuild import write_run
from doe_kc.workflow.write_correlation import AXLE, correlation_document, correlation_lines, write_correlation

CORRELATED_AXLE = (
    "{axle}: the study's axle tuned as it is; what it may lack is not looked for. doe-kc run does that first "
    "and hands over one axle with both."
)


@app.command("correlate")
@takes_study
def correlate(
    study_options: StudyOptions,
    method: Annotated[str | None, typer.Option(help="ego, gauss_newton, pareto or hybrid.")] = None,
    budget: Annotated[
        int | None, typer.Option(min=1, help="True-solver evaluations, the baseline among them.")
    ] = None,
    scheduler: SchedulerOption = None,
) -> None:
    """Tune the variables to the measured car; every candidate is confirmed by the true solver.

    The exit code is 1 where the axle is not usable, which the first line explains; all files are written.
    """
    study = study_options.read()
    reduced = study_records(study)
    correlation = correlated(
        study, reduced, method=method, budget=budget, workers=study_options.workers, scheduler=scheduler
    )
    folder, assessment = study.out / "correlate", assess(correlation)
    write_run(correlation, folder)
    records = reduced.measurement if reduced is not None else None
    written = write_correlation(
        study, correlation, records, folder, assessment=assessment, workers=study_options.workers
    )
    if study_options.json is not None:
        write_json(study_options.json, correlation_document(correlation, folder / AXLE, assessment))
    for line in correlation_lines(correlation, assessment):
        typer.echo(line)
    typer.echo(CORRELATED_AXLE.format(axle=folder / AXLE))
    typer.echo(f"{len(written)} files in {folder}; store {study.store}", err=True)
    leave_unless_usable(assessment)


def leave_unless_usable(assessment: Assessment) -> None:
    """Exit code 1 for an axle that cannot be used, so that no script goes on with it."""
    if assessment.status == "not_usable":
        raise typer.Exit(RunError.exit_code)


def correlated(study: Study, reduced: Reduced | None, **choices: Unpack[CorrelationChoices]) -> Correlation:
    """The correlation, its progress shown."""
    with correlation_bar(choices.get("budget") or study.correlation.budget) as watch:
        return run_correlation(study, reduced, watch=watch, **choices)
