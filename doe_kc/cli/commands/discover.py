"""`doe-kc discover`: names the effect that the axle lacks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import StudyOptions, takes_study
from doe_kc.cli.progress import described_bar
from doe_kc.discovery.result import Discovery
from doe_kc.ground.output import write_json
from doe_kc.measurement import Measurement
from doe_kc.study import Study
from doe_kc.workflow.discover import discover_study, expected_steps
from doe_kc.workflow.discovery_document import discovery_document, discovery_lines
from doe_kc.workflow.measure import study_measurement
from doe_kc.workflow.twin_discovery import discovery_ground

DISCOVERED_AXLE = (
    "{axle}: refitted to the records with what was found, not yet correlated to the targets; doe-kc run does "
    "both and hands over one axle."
)


@app.command("discover")
@takes_study
def discover(
    study_options: StudyOptions,
    exclude: Annotated[
        list[str] | None, typer.Option(help="Id of an effect not to look for; can be given several times.")
    ] = None,
) -> None:
    """Find where model and records disagree, name the missing effect, add it, show the gap shrink."""
    studied = study_options.read()
    ground = discovery_ground(studied, study_measurement(studied))
    study, records = ground.study, ground.records
    discovery = discovered(study, records, exclude=exclude or (), workers=study_options.workers)
    # The writers load 40 MB of libraries, which the search does without.
    from doe_kc.workflow.write_correlation import AXLE
    from doe_kc.workflow.write_discovery import write_discovery

    folder = study.out / "discover"
    written = write_discovery(study, discovery, records, folder, workers=study_options.workers)
    if study_options.json is not None:
        write_json(study_options.json, discovery_document(discovery, folder / AXLE))
    for line in discovery_lines(discovery):
        typer.echo(line)
    typer.echo(DISCOVERED_AXLE.format(axle=folder / AXLE))
    typer.echo(f"{len(written)} files in {folder}", err=True)


def discovered(
    study: Study, records: Measurement, *, exclude: Sequence[str] = (), workers: int | None = None
) -> Discovery:
    """The discovery, its progress shown."""
    with described_bar("discovery", expected_steps(study, records, exclude)) as tell:
        return discover_study(study, records, exclude=exclude, workers=workers, progress=tell)
