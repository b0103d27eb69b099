"""`doe-kc run`: the whole chain."""

from __future__ import annotations

import time

import typer

from doe_kc.cli._app import app
from doe_kc.cli.commands.correlate import correlated
from doe_kc.cli.commands.discover import discovered
from doe_kc.cli.commands.influence import influence_lines
from doe_kc.cli.commands.reduce import ride_height_line
from doe_kc.cli.given import Given, takes_study
from doe_kc.cli.options import SchedulerOption
from doe_kc.cli.progress import progress_bar
from doe_kc.output import write_json
from doe_kc.reporting.simulation_tables import characteristics_document, write_simulation
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.workflow.compare import (
    compare_model,
    comparison_document,
    comparison_lines,
    write_comparison,
)
from doe_kc.workflow.discovery_document import discovery_document, discovery_lines
from doe_kc.workflow.discovery_handover import AXLE, write_discovery
from doe_kc.workflow.handover import correlation_document, correlation_lines, write_correlation
from doe_kc.workflow.influence import (
    influence_document,
    influence_runs,
    study_influence,
    write_influence,
)
from doe_kc.workflow.measure import reduce_records, reduced_document, write_reduced
from doe_kc.workflow.recall import write_run


@app.command("run")
@takes_study
def run(given: Given, scheduler: SchedulerOption = None) -> None:
    """The whole chain: simulate, reduce, compare, influence matrix, correlate, discover; all under out."""
    started = time.perf_counter()
    found = given.read()
    found.measured()
    solution = solve(found.axle)
    seconds = time.perf_counter() - started
    model = curve_set(solution)
    written = write_simulation(solution, found.out / "simulate")
    typer.echo(f"{found.axle.name}: {solution.equilibria} equilibria in {seconds:.2f} s", err=True)

    reduced = reduce_records(found, solution)
    typer.echo("drawing the rig records and the comparison", err=True)
    written += write_reduced(reduced, found.out / "reduce", workers=given.workers, pictures=found.pictures)
    comparison = compare_model(found, model, reduced.measurement)
    written += write_comparison(
        comparison, found.out / "compare", workers=given.workers, pictures=found.pictures
    )

    with progress_bar("one at a time", influence_runs(found)) as advance:
        influence = study_influence(found, reduced.measurement, workers=given.workers, progress=advance)
    written += write_influence(found, influence, found.out / "influence", workers=given.workers)

    correlation = correlated(found, reduced, workers=given.workers, scheduler=scheduler)
    folder = found.out / "correlate"
    write_run(correlation, folder)
    written += write_correlation(found, correlation, reduced.measurement, folder, workers=given.workers)

    discovery = None
    if not found.solver.command:
        discovery = discovered(found, reduced.measurement, workers=given.workers)
        written += write_discovery(
            found, discovery, reduced.measurement, found.out / "discover", workers=given.workers
        )

    if given.json is not None:
        write_json(
            given.json,
            {
                "simulate": characteristics_document(solution, seconds),
                "reduce": reduced_document(reduced),
                "compare": comparison_document(comparison),
                "influence": influence_document(influence.matrix),
                "correlate": correlation_document(correlation, folder / "axle.toml"),
                "discover": None
                if discovery is None
                else discovery_document(discovery, found.out / "discover" / AXLE),
                "seconds": time.perf_counter() - started,
            },
        )
    blocks = [comparison_lines(comparison), influence_lines(influence.matrix), correlation_lines(correlation)]
    if discovery is not None:
        blocks.append(discovery_lines(discovery))
    for line in [line for block in blocks for line in (*block, "")][:-1]:
        typer.echo(line)
    if reduced.ride_height is not None:
        typer.echo(ride_height_line(reduced.ride_height))
    typer.echo(f"{len(written)} files under {found.out} in {time.perf_counter() - started:.0f} s")
