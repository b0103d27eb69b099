"""Tables of channels, whatever container they come from, with the row numbers that messages need."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Protocol

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.channels import Heading, parse_heading

Cell = str | float | None

ZIP_MAGIC = b"PK\x03\x04"
OLE_MAGIC = b"\xd0\xcf\x11\xe0"
_DECIMAL = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_NUMBER = re.compile(_DECIMAL)
_OF_NUMBERS = b"0123456789+-.eE"
"""Of texts of these characters alone, `float` takes those that are numbers and no others."""


class ChannelTable(Protocol):
    """What every container of rig records gives: channels by name and unit, their numbers on request."""

    @property
    def label(self) -> str:
        """File and part of it, for messages."""

    @property
    def channels(self) -> Sequence[Heading]:
        """Name and unit of each column."""

    @property
    def size(self) -> int:
        """Number of samples."""

    def numbers(self, column: int) -> FloatArray:
        """(size,) finite numbers; InputError naming the first cell that holds none."""

    def row(self, sample: int) -> int:
        """Number of a sample's row in its file, counted from 1."""


@dataclass(frozen=True)
class RecordTable:
    """Heading texts, rows of cells, and the number (counted from 1) of each row in its file.

    units: texts of a row of units below the headings, empty without one.
    """

    label: str
    headings: tuple[str, ...]
    rows: tuple[Sequence[Cell], ...]
    row_numbers: tuple[int, ...]
    decimal_comma: bool = False
    units: tuple[str, ...] = ()

    @cached_property
    def channels(self) -> tuple[Heading, ...]:
        """Headings with the unit of the row below where they have none of their own."""
        names = [parse_heading(text) for text in self.headings]
        units = [u.strip().strip("[](){}").strip() for u in self.units] + [""] * len(names)
        return tuple(
            Heading(h.name, u) if h.unit is None and u else h for h, u in zip(names, units, strict=False)
        )

    @property
    def size(self) -> int:
        """Number of samples."""
        return len(self.rows)

    @cached_property
    def columns(self) -> tuple[Sequence[Cell], ...]:
        """Cells by column."""
        return tuple(zip(*self.rows, strict=True))

    def numbers(self, column: int) -> FloatArray:
        """As `column_numbers`."""
        return column_numbers(self, column)

    def row(self, sample: int) -> int:
        """Number of a sample's row in its file."""
        return self.row_numbers[sample]


@dataclass(frozen=True)
class ArrayTable:
    """Table of a binary container. values: (n,) of each channel."""

    label: str
    channels: tuple[Heading, ...]
    values: tuple[FloatArray, ...]

    @property
    def size(self) -> int:
        """Number of samples."""
        return self.values[0].size if self.values else 0

    def numbers(self, column: int) -> FloatArray:
        """(size,) finite numbers; InputError naming the first sample that is none."""
        values = self.values[column]
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            raise InputError(
                f'{self.label}: sample {bad[0] + 1}, channel "{self.channels[column].name}" holds '
                f"{values[bad[0]]:g}; expected a finite number, so export or record the channel again."
            )
        return values

    def row(self, sample: int) -> int:
        """Number of a sample, counted from 1."""
        return sample + 1


def read_bytes(path: Path) -> bytes:
    """Contents of `path`; InputError when it cannot be read, is no file on a disk, or is empty."""
    try:
        if not path.is_file() and not path.is_dir() and path.exists():
            raise InputError(f"{path}: is a pipe or a device; expected a record file on a disk, name that.")
        data = path.read_bytes()
    except FileNotFoundError:
        raise InputError(
            f"{path}: no such file; expected a record there, so copy it or correct [records]."
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error}); expected a readable record file.") from None
    if not data.strip():
        raise InputError(f"{path}: the file is empty; expected a heading row and samples, export it again.")
    return data


def column_numbers(table: RecordTable, column: int) -> FloatArray:
    """(n,) finite numbers of a column; InputError as `number_at` for the first cell that holds none."""
    cells = table.columns[column] if table.rows else ()
    values = _plain_numbers(cells, table.decimal_comma)
    if values is not None and np.isfinite(values).all():
        return values
    return np.array([number_at(table, row, column) for row in range(len(cells))])


def _plain_numbers(cells: Sequence[Cell], decimal_comma: bool) -> FloatArray | None:
    """All cells at once where every one is a number or every one the text of a number, else None."""
    kinds = set(map(type, cells))
    if kinds <= {float, int}:
        return np.array(cells, dtype=float)
    if kinds != {str}:
        return None
    text = "".join(cells)  # type: ignore[arg-type]  # the kinds say that they are texts
    if decimal_comma:
        text, cells = text.replace(",", "."), [c.replace(",", ".") for c in cells]  # type: ignore[union-attr]
    if text.encode(errors="replace").translate(None, _OF_NUMBERS):
        return None
    try:
        return np.array(list(map(float, cells)))  # type: ignore[arg-type]
    except ValueError:
        return None


def number_at(table: RecordTable, row: int, column: int) -> float:
    """The finite number in a cell; InputError naming file, row and column otherwise."""
    cell = table.rows[row][column]
    value = _number(cell, table.decimal_comma)
    if value is not None and math.isfinite(value):
        return value
    fault = "is empty" if cell is None or cell == "" else f'holds "{_short(cell)}"'
    raise InputError(
        f'{table.label}: row {table.row(row)}, column "{table.headings[column]}" {fault}; '
        "expected a finite number, so mend the cell or record the channel again."
    )


def _number(cell: Cell, decimal_comma: bool) -> float | None:
    if cell is None or isinstance(cell, bool):
        return None
    if isinstance(cell, str):
        text = cell.replace(",", ".") if decimal_comma else cell
        return float(text) if _NUMBER.fullmatch(text) else None
    return float(cell)


def _short(cell: Cell) -> str:
    text = str(cell)
    return text if len(text) <= 24 else text[:21] + "..."
