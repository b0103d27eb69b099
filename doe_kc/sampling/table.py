"""A user's table of designs: one row a design, one column a variable, absolute values."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from doe_kc.characteristics.result_columns import design_columns
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.files import read_bytes
from doe_kc.ground.typing import FloatArray
from doe_kc.sampling._base import Request, Sampler, design_of, sampler
from doe_kc.sampling.design import Design
from doe_kc.variables import Space, Variable

if TYPE_CHECKING:
    import pandas as pd

LABEL = "label"
EXCEL = (".xlsx", ".xlsm")
HEADER_ROWS = 1
BOUND_SLACK = 1e-9
"""Share of the range by which a rounded value may be beyond a bound."""
WRITTEN_DIGITS = 1e-8
"""Tables are written with ten digits."""


@sampler
class TableSampler(Sampler):
    """Values as they are in the table; a variable without a column keeps its start, and a column `label`
    names the rows. Tied and fixed parameters may stand beside them with the study's values; results of
    designs that were evaluated are not read."""

    id: ClassVar[str] = "table"
    sized: ClassVar[bool] = False
    seeded: ClassVar[bool] = False

    def sample(self, space: Space, request: Request) -> Design:
        if request.table is None:
            raise InputError(
                'sampling: method "table" needs a file; add table = "designs.csv" to [sampling] or give '
                "the table in the study."
            )
        frame = read_frame(request.table)
        columns = _columns(frame, space, request.table)
        points = np.tile(space.start, (len(frame), 1))
        for i, variable in enumerate(space.variables):
            if variable.path in columns:
                points[:, i] = _places(frame, variable, request.table)
        design = design_of(self.id, space, points, _labels(frame))
        _check_dependent(frame, design, space, request.table)
        return design


def read_frame(file: Path) -> pd.DataFrame:
    """All cells of a CSV or Excel file as text; InputError when it is neither, or empty."""
    header = read_bytes(file, "table").partition(b"\n")[0]
    import pandas as pd

    try:
        if file.suffix.lower() in EXCEL:
            frame = pd.read_excel(file, dtype=str, engine="openpyxl")
        else:
            separator = max(",;\t", key=lambda mark: header.count(mark.encode()))
            frame = pd.read_csv(file, dtype=str, sep=separator, encoding="utf-8-sig")
    except Exception as error:  # whatever is inside: zip, XML, encoding, CSV
        reason = (str(error).splitlines() or [type(error).__name__])[0]
        raise InputError(
            f"{file}: is not a table ({reason}); expected CSV or an Excel workbook (.xlsx) with a header row."
        ) from None
    if frame.empty:
        raise InputError(f"{file}: has no row below its header; add one a design.")
    return frame.rename(columns=lambda name: str(name).strip())


def _columns(frame: pd.DataFrame, space: Space, file: Path) -> set[str]:
    dependent = space.values(space.start).keys() - set(space.paths)
    names = [n for n in design_columns(map(str, frame.columns)) if n != LABEL and n not in dependent]
    for name in names:
        if name not in space.paths:
            number = list(frame.columns).index(name) + 1
            raise InputError(
                f"{file}: column {number}, {name!r}, is not a variable of the study; remove it, or make it "
                f"one in [variables].{nearest(name, space.paths)}"
            )
    if len(set(names)) != len(names):
        twice = next(n for n in names if names.count(n) > 1)
        raise InputError(f"{file}: column {twice} is there twice; remove one.")
    if not names:
        raise InputError(f"{file}: has no column of a variable; expected parameter paths such as LLF.x.")
    return set(names)


def _check_dependent(frame: pd.DataFrame, design: Design, space: Space, file: Path) -> None:
    """InputError where a tied or fixed parameter has another value than the study gives it."""
    for place, name in enumerate(design.paths):
        if name in space.paths or name not in frame:
            continue
        for i, (cell, value) in enumerate(zip(frame[name], design.values[:, place], strict=True)):
            check_dependent(
                str(cell),
                value,
                f"{file}: row {i + HEADER_ROWS + 1}, column {name}",
                "remove the column, or make it a variable in [variables]",
            )


def check_dependent(cell: str, value: float, where: str, mend: str) -> None:
    """InputError where a cell of a tied or fixed parameter holds another value than the study gives it, to
    the digits that tables are written with. mend: what to do then."""
    try:
        agrees = math.isclose(float(cell), value, rel_tol=WRITTEN_DIGITS, abs_tol=WRITTEN_DIGITS)
    except ValueError:
        agrees = False
    if not agrees:
        raise InputError(f"{where}: {cell}, but the study ties or fixes it to {value:.10g} there; {mend}.")


def _places(frame: pd.DataFrame, variable: Variable, file: Path) -> FloatArray:
    """(n,) u of a column."""
    cells = [str(c) for c in frame[variable.path].where(frame[variable.path].notna(), "")]
    return np.array(
        [_place(cell, variable, f"{file}: row {i + HEADER_ROWS + 1}") for i, cell in enumerate(cells)]
    )


def _place(cell: str, variable: Variable, where: str) -> float:
    where = f"{where}, column {variable.path}"
    if not cell.strip():
        raise InputError(f"{where}: the value is missing; fill it in.")
    try:
        value = float(cell)
    except ValueError:
        raise InputError(f"{where}: {cell!r} is not a number.") from None
    if not math.isfinite(value):
        raise InputError(f"{where}: {cell}, expected a finite number.")
    slack = BOUND_SLACK * (variable.upper - variable.lower)
    if not variable.lower - slack <= value <= variable.upper + slack:
        raise InputError(
            f"{where}: {value:g} is outside the bounds [{variable.lower:g}, {variable.upper:g}] "
            f"{variable.unit}; change it, or widen the bounds in [variables]."
        )
    return variable.place(min(max(value, variable.lower), variable.upper))


def _labels(frame: pd.DataFrame) -> list[str]:
    if LABEL in frame:
        return [str(text) for text in frame[LABEL].fillna("")]
    return [f"row {i + HEADER_ROWS + 1}" for i in range(len(frame))]
