"""An influence matrix as a measurement: rows are parameters, columns characteristics, each up to a factor.

A column says how the parameters share in a characteristic, in percent of its largest entry or in any other
unit: only its direction counts, so that neither the unit nor the size of the characteristic has to be known.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

import numpy as np

from doe_kc.axle.design_parameters import Parameter, design_parameters
from doe_kc.axle.model import Axle
from doe_kc.characteristics import CHARACTERISTICS, Characteristic, characteristics_of
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray

if TYPE_CHECKING:
    import pandas as pd

Cells = Iterable[tuple[str, str]]
"""Pairs of globs, of parameter paths and of characteristic ids: ("upb.Tz", "*") is a row."""
FEWEST_CELLS = 2
"""Of a column that counts: the direction of a single cell says nothing."""


@dataclass(frozen=True)
class MeasuredMatrix:
    """values: (p, m) changes for a positive step of the parameter, each column in a unit of its own; nan
    where there is no entry. counted: (p, m) bool, cells that are fitted."""

    parameters: tuple[Parameter, ...]
    characteristics: tuple[Characteristic, ...]
    values: FloatArray
    counted: np.ndarray

    @property
    def fitted_columns(self) -> np.ndarray:
        """(m,) bool: columns with at least two cells that count, not all of them zero."""
        inside = np.where(self.counted, np.nan_to_num(self.values), 0.0)
        return np.asarray((self.counted.sum(axis=0) >= FEWEST_CELLS) & np.any(inside != 0.0, axis=0))

    def frame(self, values: FloatArray | np.ndarray) -> pd.DataFrame:
        """(p, m) numbers with parameter paths as index and characteristic ids as columns."""
        import pandas as pd

        rows = pd.Index([p.path for p in self.parameters], name="parameter")
        return pd.DataFrame(values, index=rows, columns=[c.id for c in self.characteristics])


def measured_matrix(frame: pd.DataFrame, axle: Axle, mask: Cells, source: str) -> MeasuredMatrix:
    """The matrix of a table: parameter paths as index, characteristic ids as columns.

    A blank in a path stands for its dot. Empty cells do not count, nor those of `mask`. A row of zeros of
    what the axle's equations do not contain, such as the radius of a rigid arm, is left out.

    Raises InputError for a name that the axle does not have or that occurs twice, a row of what its equations
    do not contain that is not zero, a cell that is not a number, a mask that meets no cell, or a table of
    which nothing is left to fit.
    """
    rows = _rows(frame, axle, source)
    columns = _columns(frame, axle, source)
    values = np.array([[_number(v, i, j, source) for j, v in row.items()] for i, row in frame.iterrows()])
    values = values.reshape(len(rows), len(columns))
    counted = np.isfinite(values)
    for row, column in mask:
        met = np.array([[fnmatchcase(p.path, row.replace(" ", ".")) for p in rows]]).T & np.array(
            [[fnmatchcase(c.id, column) for c in columns]]
        )
        if not met.any():
            raise InputError(
                f"{source}: the mask ({row!r}, {column!r}) meets no cell; expected a parameter or glob of "
                'the rows and a characteristic or glob of the columns, such as ("upb.Tz", "*").'
            )
        counted &= ~met
    _check_contained(rows, values, axle, source)
    active = np.array([p.active for p in rows], dtype=bool)
    matrix = MeasuredMatrix(tuple(p for p in rows if p.active), columns, values[active], counted[active])
    if not matrix.fitted_columns.any():
        raise InputError(
            f"{source}: nothing is left to fit; expected a column with at least {FEWEST_CELLS} cells that "
            "are not masked, not all of them zero."
        )
    return matrix


def _rows(frame: pd.DataFrame, axle: Axle, source: str) -> tuple[Parameter, ...]:
    known = {p.path: p for p in design_parameters(axle)}
    paths = [str(name).strip().replace(" ", ".") for name in frame.index]
    _check_single(paths, "row", source)
    for path in paths:
        if path not in known:
            raise InputError(
                f"{source}: row {path!r} is not a parameter of the axle {axle.name!r}; rows are named by "
                f"paths such as LLF.x or llr.Fx, remove or rename it.{nearest(path, known)}"
            )
    return tuple(known[path] for path in paths)


def _check_contained(rows: Sequence[Parameter], values: FloatArray, axle: Axle, source: str) -> None:
    """InputError for a row that is not zero of what the axle's equations do not contain."""
    for parameter, row in zip(rows, values, strict=True):
        if not parameter.active and np.any(np.nan_to_num(row) != 0.0):
            raise InputError(
                f"{source}: row {parameter.path!r}: the equations of the axle {axle.name!r} do not contain "
                "it; remove the row."
            )


def _columns(frame: pd.DataFrame, axle: Axle, source: str) -> tuple[Characteristic, ...]:
    known = [c.id for c in characteristics_of(axle)]
    names = [str(name).strip() for name in frame.columns]
    _check_single(names, "column", source)
    for name in names:
        if name not in known:
            raise InputError(
                f"{source}: column {name!r} is not a characteristic of the axle {axle.name!r}; "
                f"see docs/characteristics.md, remove or rename it.{nearest(name, known)}"
            )
    return tuple(CHARACTERISTICS[name] for name in names)


def _check_single(names: list[str], what: str, source: str) -> None:
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{source}: {what} {name!r} occurs {names.count(name)} times; keep one of them.")


def _number(value: object, row: object, column: object, source: str) -> float:
    """A cell as a number; nan of an empty one."""
    if value is None or (isinstance(value, str) and not value.strip()):
        return float("nan")
    text = value.strip().removesuffix("%") if isinstance(value, str) else value
    try:
        number = float(text)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise InputError(
            f"{source}: row {row!r}, column {column!r} is {value!r}; expected a number, or an empty cell "
            "for one that is not known."
        ) from None
    if np.isinf(number):
        raise InputError(
            f"{source}: row {row!r}, column {column!r} is {value!r}; expected a finite number, or an empty "
            "cell for one that is not known."
        )
    return number
