"""`doe-kc predict`: what a saved surrogate says of designs of a table."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Annotated

import typer

from doe_kc.cli._app import app
from doe_kc.cli.options import JsonOption
from doe_kc.ground.output import write_json
from doe_kc.surrogate_models.saved import load_surrogate
from doe_kc.workflow.predict import (
    predict_table,
    prediction_lines,
    predictions_document,
    write_predictions,
)

log = logging.getLogger("doe_kc")


@app.command("predict")
def predict(
    surrogate: Annotated[
        Path, typer.Argument(metavar="SURROGATE", help="surrogate.npz, as doe-kc surrogates writes it.")
    ],
    designs: Annotated[
        Path,
        typer.Argument(
            metavar="DESIGNS",
            help="CSV or Excel: one row a design, one column a variable; or columns parameter, value.",
        ),
    ],
    fill: Annotated[
        bool, typer.Option("--fill", help="Variables without a column keep their start values.")
    ] = False,
    out: Annotated[Path | None, typer.Option(help="CSV file for all predictions.")] = None,
    json: JsonOption = None,
) -> None:
    """Predict the characteristics of designs, with standard deviations, without the true solver."""
    predicted = predict_table(load_surrogate(surrogate), designs, fill=fill)
    for sentence in predicted.warnings:
        log.warning(sentence)
    if json is not None:
        write_json(json, predictions_document(predicted))
    if out is not None:
        typer.echo(f"wrote {write_predictions(predicted, out)}", err=True)
    for line in prediction_lines(predicted):
        typer.echo(line)
