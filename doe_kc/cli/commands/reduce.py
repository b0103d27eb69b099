"""`doe-kc reduce`: rig records to curves and targets."""

from __future__ import annotations

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import StudyOptions, takes_study
from doe_kc.ground.output import write_json
from doe_kc.measurement import RideHeight
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.workflow.compare import compare_model, comparison_lines, write_comparison
from doe_kc.workflow.measure import reduce_records, reduced_document, write_reduced


@app.command("reduce")
@takes_study
def reduce(study_options: StudyOptions) -> None:
    """Reduce rig records to curves, noise and targets; show the model against them, with pictures."""
    study = study_options.read()
    solution = solve(study.axle)
    reduced = reduce_records(study, solution)
    if study_options.json is not None:
        write_json(study_options.json, reduced_document(reduced))
    comparison = compare_model(study, curve_set(solution), reduced.measurement)
    written = write_reduced(
        reduced, study.out / "reduce", workers=study_options.workers, pictures=study.pictures
    )
    written += write_comparison(
        comparison, study.out / "compare", workers=study_options.workers, pictures=study.pictures
    )
    for line in comparison_lines(comparison):
        typer.echo(line)
    if reduced.ride_height is not None:
        typer.echo(ride_height_line(reduced.ride_height))
    typer.echo(f"{len(written)} files in {study.out / 'reduce'} and {study.out / 'compare'}", err=True)


def ride_height_line(height: RideHeight) -> str:
    """The inferred difference in words."""
    return (
        f"ride height: measured car {height.estimate:+.2f} +- {height.sd:.2f} mm against the model "
        f"(+ = body lower); consistency {height.consistency:.2f}"
    )
