"""`doe-kc sample`: a design of experiments by the true solver, into the store."""

from __future__ import annotations

from typing import Annotated

import typer

from doe_kc.campaign.export import require_format
from doe_kc.campaign.record import StoredCurves
from doe_kc.cli._app import app
from doe_kc.cli.options import SchedulerOption, StudyOptions, takes_study
from doe_kc.cli.progress import progress_bar
from doe_kc.ground.output import write_json
from doe_kc.workflow.sample import run_sample, sample_document, sample_lines, study_design, write_sample


@app.command("sample")
@takes_study
def sample(
    study_options: StudyOptions,
    method: Annotated[
        str | None, typer.Option(help="lhs, sobol, one_at_a_time, full_factorial or table.")
    ] = None,
    n: Annotated[int | None, typer.Option("--n", min=1, help="Number of designs.")] = None,
    extend: Annotated[
        bool, typer.Option("--extend", help="Count stored designs among the n: run only what completes them.")
    ] = False,
    scheduler: SchedulerOption = None,
    export: Annotated[
        str | None, typer.Option(help="Also export the whole store, curves included: csv or parquet.")
    ] = None,
    curves: Annotated[
        StoredCurves,
        typer.Option(
            help="What to store of new designs beside characteristics: all curves, their fit to a tenth of "
            "what a rig resolves, or none."
        ),
    ] = "all",
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Run stored failures again.")] = False,
) -> None:
    """Sample the variables: runs what the store does not have yet, and keeps every result."""
    form = require_format(export) if export is not None else None
    study = study_options.read()
    design = study_design(study, method=method, n=n, extend=extend)
    with progress_bar(design.method, len(design.values)) as advance:
        sampled = run_sample(
            study,
            design,
            workers=study_options.workers,
            scheduler=scheduler,
            retry_failed=retry_failed,
            stored_curves=curves,
            progress=advance,
        )
    if study_options.json is not None:
        write_json(study_options.json, sample_document(study, sampled))
    written = write_sample(study, sampled, study.out / "sample", form)
    for line in sample_lines(sampled):
        typer.echo(line)
    typer.echo(f"{len(written)} files in {study.out / 'sample'}; store {study.store}", err=True)
