"""Identification: a table with an influence matrix to the axle that has it, tables and pictures of that."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from doe_kc.axle.model import Axle
from doe_kc.axle_file.write import write_axle
from doe_kc.ground.errors import InputError
from doe_kc.ground.output import write_csv
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.identification.identification import (
    CELL_NOISE,
    IDENTIFICATION_STARTS,
    Identification,
    identification,
)
from doe_kc.identification.matrix_model import MatrixModel
from doe_kc.identification.measured_matrix import measured_matrix
from doe_kc.identification.unknowns import Free, unknowns
from doe_kc.sampling.table import read_frame

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MatrixView = Literal["measured", "identified", "difference"]
MATRIX_VIEWS: tuple[MatrixView, ...] = ("measured", "identified", "difference")
LEAST_DIFFERENCE = 1.0
"""Percent of a column's largest entry that the colours of the difference reach at least."""


@dataclass(frozen=True)
class IdentifyOptions:
    """noise: standard deviation of a cell, a share of the length of its column. any_sign: whether each column
    may have the opposite sign throughout. wheel_radius_held: whether WLC.z moves the contact point along."""

    starts: int = IDENTIFICATION_STARTS
    seed: int = 0
    noise: float = CELL_NOISE
    any_sign: bool = True
    wheel_radius_held: bool = False

    def check(self) -> None:
        """InputError for a number out of its range."""
        if self.starts < 1:
            raise InputError(f"identify: starts is {self.starts}, expected 1 or more.")
        if not 0.0 < self.noise < 1.0:
            raise InputError(
                f"identify: noise is {self.noise}, expected a share of a column, above 0, below 1."
            )


def read_matrix(path: Path) -> pd.DataFrame:
    """The table of a CSV file or of the first sheet of a workbook: its first column are the parameters."""
    frame = read_frame(path)
    return frame.set_index(frame.columns[0]).astype(object).where(lambda cells: cells.notna(), None)


def identify_axle(
    frame: pd.DataFrame,
    axle: Axle,
    free: Free | None,
    mask: Iterable[tuple[str, str]],
    options: IdentifyOptions,
    *,
    source: str,
    workers: int | None = None,
    watch: Callable[[str, int, int], None] = lambda *_: None,
) -> Identification:
    """The axle that has a matrix; InputError for what is wrong with the table, the mask or the unknowns."""
    options.check()
    measured = measured_matrix(frame, axle, mask, source)
    model = MatrixModel(
        unknowns(axle, free, "identify"),
        measured,
        options.noise,
        options.any_sign,
        options.wheel_radius_held,
    )
    return identification(model, starts=options.starts, seed=options.seed, workers=workers, watch=watch)


def agreement_frame(result: Identification) -> pd.DataFrame:
    """One row a characteristic, its id as index: magnitude and signed correlation of the identified axle and
    of the axle at the start, overall sign, number of cells, and whether the column was fitted."""
    import pandas as pd

    after, before = result.agreement, result.agreement_before
    columns = {
        "magnitude": after.magnitude,
        "signed": after.signed,
        "sign": after.sign,
        "cells": after.cells,
        "magnitude_before": before.magnitude,
        "signed_before": before.signed,
        "fitted": result.measured.fitted_columns,
    }
    ids = [c.id for c in result.measured.characteristics]
    return pd.DataFrame(columns, index=pd.Index(ids, name="characteristic"))


def cells_frame(result: Identification) -> pd.DataFrame:
    """One row a cell: parameter, characteristic, measured, identified and difference in the column's unit,
    fitted (False of a masked or empty cell)."""
    import numpy as np
    import pandas as pd

    m, own = result.measured, result.in_measured_units
    columns = {
        "parameter": np.repeat([p.path for p in m.parameters], len(m.characteristics)),
        "characteristic": [c.id for c in m.characteristics] * len(m.parameters),
        "measured": m.values.ravel(),
        "identified": own.ravel(),
        "difference": (own - m.values).ravel(),
        "fitted": (m.counted & m.fitted_columns).ravel(),
    }
    return pd.DataFrame(columns)


def identification_lines(result: Identification) -> list[str]:
    """What it found, in a few lines."""
    magnitude, signed = result.agreement.means
    before, signed_before = result.agreement_before.means
    values, starts = result.parameters(), result.starts()
    bound = list(values.index[values["at_bound"]])
    near = int((starts["cost"] <= 1.01 * result.best.cost).sum())
    lines = [
        f"mean correlation of the columns {magnitude:.3f} (magnitudes) and {signed:.3f} (signed); "
        f"{before:.3f} and {signed_before:.3f} before",
        f"{len(values)} unknowns, {result.informed} directions of which the matrix says more than the prior",
        f"a cell misses by {result.cell_noise:.3f} of its column's length; assumed {result.model.noise:g}",
        f"{near} of {len(starts)} starts within 1 % of the least cost",
    ]
    if bound:
        lines.append(f"at a bound: {', '.join(bound)}")
    return lines


def draw_identification(ax: Axes, result: Identification, view: MatrixView, *, scale: bool = True) -> None:
    """One of the three heat maps, each column in percent of the largest measured entry that was fitted; in
    the difference, on a scale of its own, cells that were not fitted are grey."""
    import numpy as np

    from doe_kc.reports.drawing.matrix_plot import draw_matrix_plot

    m, own = result.measured, result.in_measured_units
    fitted = np.where(m.counted, np.abs(np.nan_to_num(m.values)), 0.0).max(axis=0)
    peak = np.where(fitted > 0, fitted, np.nanmax(np.abs(own), axis=0))
    seen = np.where(m.counted & m.fitted_columns, own - m.values, np.nan)
    values = {"measured": m.values, "identified": own, "difference": seen}[view]
    titles = {
        "measured": "Measured",
        "identified": "Identified axle",
        "difference": "Identified less measured",
    }
    percent, title, full = 100.0 * values / peak, titles[view], 100.0
    if view == "difference":
        largest = float(np.nanmax(np.abs(percent), initial=0.0))
        title, full = f"{title}: at most {largest:.2g} percent", max(largest, LEAST_DIFFERENCE)
    draw_matrix_plot(ax, m.frame(percent), title, scale=scale, full=full)


def identification_figure(result: Identification) -> Figure:
    """Measured matrix, that of the identified axle, and their difference side by side."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from doe_kc.reports.drawing.matrix_plot import matrix_size

    m = result.measured
    width, height = matrix_size(m.frame(m.values))
    fig = Figure(figsize=(3.0 * width - 1.6, height), dpi=150, layout="constrained")
    FigureCanvasAgg(fig)
    for k, (ax, view) in enumerate(zip(fig.subplots(1, 3), MATRIX_VIEWS, strict=True)):
        draw_identification(ax, result, view, scale=k > 0)
    return fig


def write_identification(
    result: Identification, folder: Path, *, axle_path: Path | None, pictures: PictureFormat = PNG
) -> list[Path]:
    """Paths of agreement.csv, cells.csv, parameters.csv, directions.csv, starts.csv, a picture, and axle.toml
    where the axle came from a file."""
    tables = {
        "agreement": agreement_frame(result).reset_index(),
        "cells": cells_frame(result),
        "parameters": result.parameters().reset_index(),
        "directions": result.directions().reset_index(),
        "starts": result.starts().reset_index(),
    }
    written = [write_csv(folder / f"{name}.csv", frame) for name, frame in tables.items()]
    if axle_path is not None:
        note = "identified from an influence matrix"
        written.append(write_axle(result.axle, axle_path, folder / "axle.toml", note=note))
    if pictures != "none":
        from doe_kc.reports.drawing.style import save

        written.append(save(identification_figure(result), folder / "identification", pictures))
    return written


def identification_document(result: Identification) -> dict[str, Any]:
    """Means and counts, agreement by characteristic, parameters by path, starts as a list."""
    magnitude, signed = result.agreement.means
    return {
        "magnitude": magnitude,
        "signed": signed,
        "informed": result.informed,
        "noise": result.cell_noise,
        "agreement": agreement_frame(result).to_dict("index"),
        "parameters": result.parameters().to_dict("index"),
        "starts": result.starts().to_dict("records"),
    }
