"""Predictions of a saved surrogate for designs of a table."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from doe_kc.characteristics.result_columns import design_columns
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.output import write_columns
from doe_kc.ground.typing import FloatArray
from doe_kc.sampling.table import HEADER_ROWS, LABEL, check_dependent, read_frame
from doe_kc.surrogate_models.report import SurrogateReport
from doe_kc.surrogate_models.saved import Input, Output, SavedSurrogate
from doe_kc.surrogate_models.validation import NOMINAL_WIDTH

if TYPE_CHECKING:
    import pandas as pd

HEAD = re.compile(r"^(?P<path>[^\[\]]+?)\s*(?:\[(?P<unit>[^\]]*)\])?$")
LIST_COLUMNS = {"parameter", "value"}
"""Columns of a list of parameters, one a row; `unit` may stand beside them."""
MEND = "remove it, or fit the surrogate with it as a variable"
"""What to do with a parameter that the surrogate's study ties or fixes to another value."""
OUTSIDE_SLACK = 1e-9
"""Of the unit cube, within which a value counts as inside its bounds."""


@dataclass(frozen=True)
class Predicted:
    """labels: (p,). values: (p, d) absolute. mean, sd: (p, m) in the outputs' units. warnings: sentences."""

    saved: SavedSurrogate
    labels: tuple[str, ...]
    values: FloatArray
    mean: FloatArray
    sd: FloatArray
    warnings: tuple[str, ...]


def saved_surrogate(report: SurrogateReport, *, study: str) -> SavedSurrogate:
    """What `predict` needs of a surrogate study."""
    fitted = report.fitted
    q2, rmse = (
        fitted.of_chosen({k: getattr(j.quality, what) for k, j in fitted.models.items()})
        for what in ("q2", "rmse")
    )
    inputs = tuple(
        Input(v.path, v.unit, v.lower, v.upper, v.start, v.logarithmic) for v in report.space.variables
    )
    outputs = tuple(
        Output(c.id, c.label, c.unit, fitted.chosen[j], float(q2[j]), float(rmse[j]))
        for j, c in enumerate(report.designs.characteristics)
    )
    space = report.space
    return SavedSurrogate(
        study, len(report.designs.x), inputs, outputs, fitted.model, space.ties, dict(space.fixed or {})
    )


def predict_table(saved: SavedSurrogate, table: Path, *, fill: bool = False) -> Predicted:
    """Predictions for every row of a table of designs, or for a list of parameters.

    A table has a column a variable, `PATH` or `PATH [unit]`, and may have `label`; results of designs that
    were evaluated are not read. A list has the columns parameter, value and perhaps unit; what it does not
    name keeps its start. fill: columns that are missing from a table do so too. Parameters that were tied or
    fixed in the surrogate's designs may stand beside the variables, with the values that they had there.
    InputError naming file, row and column; values outside the bounds are a warning.
    """
    frame = read_frame(table)
    if set(frame.columns) >= LIST_COLUMNS:
        labels, values = _listed(saved, frame, table)
    else:
        labels, values = _tabled(saved, frame, table, fill)
    points = saved.places(values)
    mean, sd = saved.predict(values)
    return Predicted(saved, labels, values, mean, sd, tuple(_outside(saved, labels, values, points, table)))


def _tabled(
    saved: SavedSurrogate, frame: pd.DataFrame, table: Path, fill: bool
) -> tuple[tuple[str, ...], FloatArray]:
    columns: dict[str, str] = {}
    beside: dict[str, str] = {}
    for head in design_columns(map(str, frame.columns)):
        if head == LABEL:
            continue
        if (path := _parts(head)[0]) in saved.dependent_paths:
            beside[head] = path
            continue
        known = _known(saved, head, f"{table}: column {head!r}")
        if known.path in columns:
            raise InputError(f"{table}: column {known.path} is there twice; remove one.")
        columns[known.path] = head
    missing = [known.path for known in saved.inputs if known.path not in columns]
    if missing and not fill:
        raise InputError(
            f"{table}: has no column {missing[0]!r}, and {len(missing) - 1} others of the surrogate's "
            f"{len(saved.inputs)} variables are missing; add them, or keep their start values with --fill."
        )
    values = np.tile([known.start for known in saved.inputs], (len(frame), 1))
    for j, known in enumerate(saved.inputs):
        if known.path in columns:
            cells = frame[columns[known.path]]
            values[:, j] = [
                _number(cell, known, f"{table}: row {i + HEADER_ROWS + 1}, column {columns[known.path]!r}")
                for i, cell in enumerate(cells)
            ]
    dependent = saved.dependent(values)
    for head, path in beside.items():
        for i, (cell, value) in enumerate(zip(frame[head], dependent[path], strict=True)):
            where = f"{table}: row {i + HEADER_ROWS + 1}, column {head!r}"
            check_dependent(str(cell), float(value), where, MEND)
    numbered = [f"row {i + HEADER_ROWS + 1}" for i in range(len(frame))]
    labels = [str(text) for text in frame[LABEL].fillna("")] if LABEL in frame else numbered
    return tuple(labels), values


def _listed(saved: SavedSurrogate, frame: pd.DataFrame, table: Path) -> tuple[tuple[str, ...], FloatArray]:
    values = {known.path: known.start for known in saved.inputs}
    beside: list[tuple[str, str, str]] = []
    seen: set[str] = set()
    for i, row in frame.iterrows():
        where = f"{table}: row {int(str(i)) + HEADER_ROWS + 1}"
        if (path := str(row["parameter"]).strip()) in saved.dependent_paths:
            beside.append((path, str(row["value"]), f"{where}, {path}"))
            continue
        unit = str(row["unit"]) if "unit" in frame and isinstance(row["unit"], str) else None
        head = str(row["parameter"]) + (f" [{unit}]" if unit is not None else "")
        known = _known(saved, head, f"{where}, parameter {row['parameter']!r}")
        if known.path in seen:
            raise InputError(f"{where}: {known.path} is there twice; remove one.")
        seen.add(known.path)
        values[known.path] = _number(row["value"], known, f"{where}, {known.path}")
    design = np.array([list(values.values())])
    dependent = saved.dependent(design)
    for path, cell, place in beside:
        check_dependent(cell, float(dependent[path][0]), place, MEND)
    return (table.stem,), design


def _parts(head: str) -> tuple[str, str | None]:
    """Path and unit of a head `PATH` or `PATH [unit]`."""
    match = HEAD.match(head.strip())
    return (match["path"], match["unit"]) if match else (head, None)


def _known(saved: SavedSurrogate, head: str, where: str) -> Input:
    """The variable that a head names, its unit checked."""
    paths = {known.path: known for known in saved.inputs}
    path, unit = _parts(head)
    if path not in paths:
        raise InputError(
            f"{where}: is no variable of the surrogate; remove it, or fit the surrogate with it."
            f"{nearest(path, paths)}"
        )
    known = paths[path]
    if unit is not None and unit.strip() != known.unit:
        raise InputError(f"{where}: unit {unit.strip()!r}, expected {known.unit!r}; convert the values.")
    return known


def _number(cell: Any, known: Input, where: str) -> float:
    text = "" if cell is None or cell != cell else str(cell).strip()
    if not text:
        raise InputError(f"{where}: the value is missing; fill it in.")
    try:
        value = float(text)
    except ValueError:
        raise InputError(f"{where}: {text!r} is not a number.") from None
    if not math.isfinite(value):
        raise InputError(f"{where}: {text}, expected a finite number.")
    if known.logarithmic and value <= 0.0:
        raise InputError(f"{where}: {value:g}, expected a number > 0 {known.unit}.".replace(" -.", "."))
    return value


def _outside(
    saved: SavedSurrogate, labels: tuple[str, ...], values: FloatArray, points: FloatArray, table: Path
) -> list[str]:
    """A sentence a variable that is beyond its bounds in some row."""
    beyond = (points < -OUTSIDE_SLACK) | (points > 1.0 + OUTSIDE_SLACK)
    sentences = []
    for j in np.flatnonzero(beyond.any(axis=0)):
        known, rows = saved.inputs[j], np.flatnonzero(beyond[:, j])
        more = f" (and in {rows.size - 1} other rows)" if rows.size > 1 else ""
        sentences.append(
            f"{table}: {known.path} = {values[rows[0], j]:g} in {labels[rows[0]]} is outside the "
            f"bounds [{known.lower:g}, {known.upper:g}] {known.unit} of the designs{more}; that extrapolates."
        )
    return sentences


def write_predictions(predicted: Predicted, path: Path) -> Path:
    """CSV, one row a design: label, then mean and standard deviation (`ID sd`) of every output."""
    return write_columns(path, prediction_columns(predicted))


def prediction_columns(predicted: Predicted) -> dict[str, Any]:
    """`label`, then mean and standard deviation (`ID sd`) of every output, a column each."""
    columns: dict[str, Any] = {LABEL: list(predicted.labels)}
    for j, known in enumerate(predicted.saved.outputs):
        columns[known.id], columns[f"{known.id} sd"] = predicted.mean[:, j], predicted.sd[:, j]
    return columns


def predictions_document(predicted: Predicted) -> dict[str, Any]:
    """`{"designs": [{"label", "characteristics": {id: {"mean", "sd", "unit"}}}], "warnings"}`."""
    outputs = predicted.saved.outputs
    return {
        "designs": [
            {
                "label": label,
                "characteristics": {
                    o.id: {"mean": float(m), "sd": float(s), "unit": o.unit}
                    for o, m, s in zip(outputs, mean, sd, strict=True)
                },
            }
            for label, mean, sd in zip(predicted.labels, predicted.mean, predicted.sd, strict=True)
        ],
        "warnings": list(predicted.warnings),
    }


def prediction_lines(predicted: Predicted) -> list[str]:
    """For a terminal: every output of the first design with its 95 % interval."""
    first = f"{predicted.labels[0]}, mean and half width of the 95 % interval"
    lines = [f"{first}, first of {len(predicted.labels)} designs" if len(predicted.labels) > 1 else first]
    for known, mean, sd in zip(predicted.saved.outputs, predicted.mean[0], predicted.sd[0], strict=True):
        lines.append(f"{known.id:32}{mean:>14.6g} ± {NOMINAL_WIDTH * sd:<10.3g}  {known.unit}")
    return lines
