"""Identification: the axle that has an influence matrix."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from doe_kc.api.axle import as_axle
from doe_kc.api.frame_result import FrameResult
from doe_kc.api.studies import Progress
from doe_kc.axle import Axle
from doe_kc.ground.errors import InputError
from doe_kc.identification.identification import CELL_NOISE, IDENTIFICATION_STARTS, Identification
from doe_kc.identification.unknowns import Free
from doe_kc.workflow.identify import (
    MATRIX_VIEWS,
    IdentifyOptions,
    MatrixView,
    agreement_frame,
    cells_frame,
    draw_identification,
    identification_lines,
    identify_axle,
    read_matrix,
    write_identification,
)

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False, eq=False)
class IdentificationResult(FrameResult):
    """What an influence matrix says of an axle. identification: the fits of all starts; axle_path: the file
    of the axle at the start, None where it is of no file."""

    identification: Identification
    axle_path: Path | None

    @property
    def axle(self) -> Axle:
        """The identified axle."""
        return self.identification.axle

    def to_frame(self) -> pd.DataFrame:
        """One row a characteristic, its id as index.

        magnitude, signed: correlation coefficient of the column's magnitudes and of its signed entries, over
        the cells that were not masked; sign: -1 where the whole column has the opposite sign; cells: how
        many; magnitude_before, signed_before: of the axle at the start; fitted: False of a column that was
        masked or is zero.
        """
        return agreement_frame(self.identification)

    @property
    def cells(self) -> pd.DataFrame:
        """One row a cell: parameter, characteristic, measured, identified, difference, fitted; in the unit of
        the measured column. Of a masked cell `identified` is its prediction."""
        return cells_frame(self.identification)

    @property
    def parameters(self) -> pd.DataFrame:
        """One row an unknown, its path as index: start, identified, lower, upper (absolute, in `unit`),
        sd_before, sd_after, moved (in prior standard deviations), at_bound."""
        return self.identification.parameters()

    @property
    def directions(self) -> pd.DataFrame:
        """One row a direction of the unknowns, best known first: information (1: the matrix says as much as
        the prior), sd_ratio after over before, unknowns that it mostly consists of."""
        return self.identification.directions()

    @property
    def starts(self) -> pd.DataFrame:
        """One row a start, best first: cost, magnitude, signed, converged, steps, distance from the best."""
        return self.identification.starts()

    @property
    def lines(self) -> list[str]:
        """Agreement, what the matrix informs, noise, starts."""
        matrix = self.identification.measured
        size = f"{len(matrix.parameters)} parameters x {len(matrix.characteristics)} characteristics"
        return [f"{self.axle.name}, {size}", *identification_lines(self.identification)]

    def plot(self, view: MatrixView = "difference", ax: Axes | None = None) -> Axes:
        """Heat map of the measured matrix, of the identified axle's, or of their difference, percent of each
        column's largest measured entry; InputError for another word."""
        from doe_kc.api.axes import axes_or_new
        from doe_kc.reports.drawing.matrix_plot import matrix_size

        if view not in MATRIX_VIEWS:
            raise InputError(f"view {view!r}: expected {', '.join(MATRIX_VIEWS)}.")
        matrix = self.identification.measured
        ax = axes_or_new(ax, matrix_size(matrix.frame(matrix.values)))
        draw_identification(ax, self.identification, view)
        return ax

    def write(self, out: str | PathLike[str]) -> list[Path]:
        """What `doe-kc identify --out` writes; axle.toml only where the axle came as a path."""
        return write_identification(self.identification, Path(out), axle_path=self.axle_path)


def identify(
    matrix: pd.DataFrame | str | PathLike[str],
    axle: Axle | str | PathLike[str],
    free: Free | None = None,
    mask: Iterable[tuple[str, str]] = (),
    *,
    starts: int = IDENTIFICATION_STARTS,
    seed: int = 0,
    noise: float = CELL_NOISE,
    any_sign: bool = True,
    wheel_radius_held: bool = False,
    workers: int | None = None,
    progress: Progress | None = None,
) -> IdentificationResult:
    """The axle whose influence matrix is nearest to a measured one, such as a supplier's or a published one.

    Only the direction of each column counts, so that percent of the column's largest entry will do, or any
    unit. What the matrix does not say stays at the prior: at `axle`, which must be of the same layout.

    matrix: parameter paths as index, characteristic ids as columns, changes for a positive step (1 mm, a
    tenth of a stiffness); or the path of such a table, CSV or workbook. Empty cells are left out. free: paths
    or globs that may change, by default all hardpoints and bushing stiffnesses; as a mapping with a prior
    standard deviation each: mm (10 by default), or a ratio of a size (2.5). Bounds are 2.5 of them away.
    mask: cells that are left out and predicted, pairs of globs of parameter and characteristic. noise:
    standard deviation of a cell, a share of its column's length (root of the sum of squares). any_sign:
    whether each column is known but for its sign, as under another convention of the load case.
    wheel_radius_held: whether WLC.z moves the contact point along with the wheel centre, as in ADAMS/Car,
    instead of the ground staying where it is, as here. starts: fits from `axle` and from points about it;
    seed: of these. workers: processes, one per core by default.

    Minimizes |u - v|^2 / noise^2 + |z|^2 of unit columns u (own) and v (measured) and the unknowns z in prior
    standard deviations, by Levenberg-Marquardt within bounds on exact sensitivities.

    Raises InputError for a table, glob or number that is wrong, RunError where the axle has no equilibrium.

    >>> matrix = kc.influence("examples/front_axle", workers=1).to_frame("exact")
    >>> result = kc.identify(matrix, "examples/front_axle/axle.toml", ["llr.F?"], starts=1, workers=1)
    >>> round(float(result.to_frame()["signed"].min()), 6)
    1.0
    """
    import pandas as pd

    of_file = not isinstance(matrix, pd.DataFrame)
    frame = read_matrix(Path(matrix)) if not isinstance(matrix, pd.DataFrame) else matrix
    result = identify_axle(
        frame,
        as_axle(axle),
        free,
        mask,
        IdentifyOptions(starts, seed, noise, any_sign, wheel_radius_held),
        source=str(matrix) if of_file else "identify",
        workers=workers,
        watch=progress or (lambda *_: None),
    )
    return IdentificationResult(result, None if isinstance(axle, Axle) else Path(axle))
