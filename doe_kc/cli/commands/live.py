"""`doe-kc live`: a local page on which the axle is explored by hand."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Annotated

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import MeasurementOption, OutOption, StudyArgument
from doe_kc.ground.errors import InputError
from doe_kc.study import read_study
from doe_kc.workflow.measure import study_records

NEEDED = ("starlette", "uvicorn", "websockets")


@app.command("live")
def live(
    study: StudyArgument,
    measurement: MeasurementOption = None,
    out: OutOption = None,
    port: Annotated[
        int, typer.Option(min=1024, max=65535, help="Of 127.0.0.1; the next free one if it is taken.")
    ] = 8350,
    idle: Annotated[
        float, typer.Option(min=0.01, max=1440.0, help="Minutes without an open tab after which it ends.")
    ] = 10.0,
    browser: Annotated[
        bool, typer.Option(help="Open the page; --no-browser prints its address only.")
    ] = True,
) -> None:
    """Move hardpoints and rates by hand on a local page, and watch the true model beside the records.

    Nothing leaves this computer. Needs the extra live: pip install "doe-kc[live]".
    """
    if missing := [name for name in NEEDED if find_spec(name) is None]:
        raise InputError(f'{", ".join(missing)} not installed; run pip install "doe-kc[live]".')
    from doe_kc.live.model import live_model
    from doe_kc.live.run import serve
    from doe_kc.live.session import Session

    chosen = read_study(study, measurement=measurement, out=out)
    session = Session(live_model(chosen, study_records(chosen)))
    serve(session, port=port, idle=60.0 * idle, browser=browser, say=lambda line: typer.echo(line, err=True))
    typer.echo("the live page has ended", err=True)
