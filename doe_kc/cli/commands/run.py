"""`doe-kc run`: the whole chain, and the one axle that it hands over."""

from __future__ import annotations

from functools import partial
from typing import Any

import typer

from doe_kc.cli._app import app
from doe_kc.cli.commands.correlate import correlated, leave_unless_usable
from doe_kc.cli.commands.discover import discovered
from doe_kc.cli.commands.influence import influence_shown
from doe_kc.cli.commands.reduce import ride_height_line
from doe_kc.cli.options import SchedulerOption, StudyOptions, takes_study
from doe_kc.correlation.result import Correlation
from doe_kc.ground.output import write_json
from doe_kc.parameter_influence.selection_result import Selection
from doe_kc.reports.simulation.tables import characteristics_document
from doe_kc.study import Study
from doe_kc.workflow.adopt import Adoption
from doe_kc.workflow.answer import PAGE, answer_lines, summary_document
from doe_kc.workflow.chain import Chain, Steps, run_chain
from doe_kc.workflow.compare import comparison_document
from doe_kc.workflow.discovery_document import discovery_document, discovery_lines
from doe_kc.workflow.influence import influence_document, influence_lines
from doe_kc.workflow.measure import Reduced, reduced_document
from doe_kc.workflow.run_files import RunFiles
from doe_kc.workflow.write_correlation import AXLE, correlation_document, correlation_lines


@app.command("run")
@takes_study
def run(study_options: StudyOptions, scheduler: SchedulerOption = None) -> None:
    """The whole chain: reduce, influence, discover, add what is missing, correlate; one axle under out.

    The exit code is 1 where that axle is not usable, which the first line explains; all files are written.
    """
    study, workers = study_options.read(), study_options.workers
    files = RunFiles(study, workers=workers)
    steps = Steps(
        influence=partial(influence_shown, workers=workers),
        discover=partial(discovered, workers=workers),
        correlate=partial(_correlated, workers=workers, scheduler=scheduler),
        say=partial(typer.echo, err=True),
    )
    chain = run_chain(study, steps, files)
    if study_options.json is not None:
        write_json(study_options.json, chain_document(study, chain))
    for line in chain_lines(chain):
        typer.echo(line)
    typer.echo(f"The answer: {study.out / AXLE}, {study.out / PAGE}")
    typer.echo(f"{len(files.paths)} files under {study.out} in {chain.record.seconds:.0f} s")
    leave_unless_usable(chain.answer.assessment)


def chain_document(study: Study, chain: Chain) -> dict[str, Any]:
    """What `run --json` writes: summary.json, and the document of every step."""
    correlation, assessment, discovery = (
        chain.answer.correlation,
        chain.answer.assessment,
        chain.answer.discovery,
    )
    return {
        **summary_document(correlation, assessment, chain.record, str(study.out / AXLE)),
        "simulate": characteristics_document(chain.solution, chain.solving_seconds),
        "reduce": reduced_document(chain.reduced),
        "compare": comparison_document(chain.comparison),
        "influence": influence_document(chain.influence.matrix),
        "correlate": correlation_document(correlation, study.out / "correlate" / AXLE, assessment),
        "discover": None
        if discovery is None
        else discovery_document(discovery, study.out / "discover" / AXLE),
    }


def chain_lines(chain: Chain) -> list[str]:
    """The outcome for a terminal, its status first, an empty line between the steps."""
    answer, height = chain.answer, chain.reduced.ride_height
    blocks = [answer_lines(answer.assessment, chain.record), influence_lines(chain.influence.matrix)]
    if answer.discovery is not None:
        blocks.append(discovery_lines(answer.discovery))
    blocks.append(correlation_lines(answer.correlation, answer.assessment)[1:])
    lines = [line for block in blocks for line in (*block, "")][:-1]
    return lines if height is None else [*lines, ride_height_line(height)]


def _correlated(
    study: Study,
    reduced: Reduced,
    adoption: Adoption | None,
    selection: Selection | None,
    *,
    workers: int | None,
    scheduler: str | None,
) -> Correlation:
    """The correlation of the extended axle, its progress shown."""
    return correlated(
        study, reduced, adoption=adoption, selection=selection, workers=workers, scheduler=scheduler
    )
