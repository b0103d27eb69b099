"""`doe-kc run`: the whole chain, and the one axle that it hands over."""

from __future__ import annotations

import time
from functools import partial

import typer

from doe_kc.cli._app import app
from doe_kc.cli.commands.correlate import correlated, leave_unless_usable
from doe_kc.cli.commands.discover import discovered
from doe_kc.cli.commands.influence import influence_lines
from doe_kc.cli.commands.reduce import ride_height_line
from doe_kc.cli.options import SchedulerOption
from doe_kc.cli.progress import progress_bar
from doe_kc.cli.study_options import StudyOptions, takes_study
from doe_kc.correlation.result import Correlation
from doe_kc.ground.output import write_json
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.report.simulation_tables import characteristics_document, write_simulation
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.study import Study
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.answer import answer_lines, answer_record, summary_document
from doe_kc.workflow.chain import Steps, follow_chain
from doe_kc.workflow.compare import compare_model, comparison_document, write_comparison
from doe_kc.workflow.discovery_document import discovery_document, discovery_lines
from doe_kc.workflow.influence import influence_document, influence_runs, study_influence, write_influence
from doe_kc.workflow.measure import Reduced, reduce_records, reduced_document, write_reduced
from doe_kc.workflow.reload_correlation import write_chain
from doe_kc.workflow.write_answer import write_answer
from doe_kc.workflow.write_correlation import AXLE, correlation_document, correlation_lines, write_correlation
from doe_kc.workflow.write_discovery import write_discovery


@app.command("run")
@takes_study
def run(study_options: StudyOptions, scheduler: SchedulerOption = None) -> None:
    """The whole chain: reduce, influence, discover, add what is missing, correlate; one axle under out.

    The exit code is 1 where that axle is not usable, which the first line explains; all files are written.
    """
    started = time.perf_counter()
    study, workers = study_options.read(), study_options.workers
    study.measured()
    solution = solve(study.axle)
    seconds = time.perf_counter() - started
    written = write_simulation(solution, study.out / "simulate")
    typer.echo(f"{study.axle.name}: {solution.equilibria} equilibria in {seconds:.2f} s", err=True)

    reduced = reduce_records(study, solution)
    measurement = reduced.measurement
    typer.echo("drawing the rig records", err=True)
    written += write_reduced(reduced, study.out / "reduce", workers=workers, pictures=study.pictures)

    with progress_bar("one at a time", influence_runs(study)) as advance:
        influence = study_influence(study, measurement, workers=workers, progress=advance)
    written += write_influence(study, influence, study.out / "influence", workers=workers)

    steps = Steps(
        discover=partial(discovered, workers=workers),
        correlate=partial(_correlated, selection=influence.selection, workers=workers, scheduler=scheduler),
    )
    answer = follow_chain(study, reduced, steps)
    correlation, assessment, discovery = answer.correlation, answer.assessment, answer.discovery
    folder = study.out / "correlate"
    if discovery is not None:
        written += write_discovery(study, discovery, measurement, study.out / "discover", workers=workers)
    write_chain(answer, answer_record(answer, time.perf_counter() - started), folder)
    written += write_correlation(
        study, correlation, measurement, folder, assessment=assessment, workers=workers
    )
    model = correlation.best.outcome.curves or curve_set(solution)
    comparison = compare_model(study, model, measurement)
    written += write_comparison(comparison, study.out / "compare", workers=workers, pictures=study.pictures)
    record = answer_record(answer, time.perf_counter() - started)
    write_chain(answer, record, folder)
    written += write_answer(study, correlation, assessment, record, measurement)

    if study_options.json is not None:
        write_json(
            study_options.json,
            {
                **summary_document(correlation, assessment, record, str(study.out / AXLE)),
                "simulate": characteristics_document(solution, seconds),
                "reduce": reduced_document(reduced),
                "compare": comparison_document(comparison),
                "influence": influence_document(influence.matrix),
                "correlate": correlation_document(correlation, folder / "axle.toml", assessment),
                "discover": None
                if discovery is None
                else discovery_document(discovery, study.out / "discover" / "axle.toml"),
            },
        )
    blocks = [answer_lines(assessment, record), influence_lines(influence.matrix)]
    if discovery is not None:
        blocks.append(discovery_lines(discovery))
    blocks.append(correlation_lines(correlation, assessment)[1:])
    for line in [line for block in blocks for line in (*block, "")][:-1]:
        typer.echo(line)
    if reduced.ride_height is not None:
        typer.echo(ride_height_line(reduced.ride_height))
    typer.echo(f"The answer: {study.out / AXLE}, {study.out / 'index.html'}")
    typer.echo(f"{len(written)} files under {study.out} in {record.seconds:.0f} s")
    leave_unless_usable(assessment)


def _correlated(
    study: Study,
    reduced: Reduced,
    adoption: Adoption | None,
    *,
    selection: Selection | None,
    workers: int | None,
    scheduler: str | None,
) -> Correlation:
    """The correlation of the extended axle, its progress shown."""
    return correlated(
        study, reduced, adoption=adoption, selection=selection, workers=workers, scheduler=scheduler
    )
