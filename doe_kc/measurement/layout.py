"""Where headings, units and samples are in a grid of cells that a rig's software wrote."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from doe_kc.measurement.units import is_unit

GridRow = Sequence[object]
NUMBER_ROWS = 5
"""Consecutive rows of numbers that begin the samples: settings above them hold fewer."""
_NUMBER_CELL = re.compile(r"\s*[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?\s*")
_GAP = frozenset(("nan", "-nan", "nan(ind)", "inf", "-inf"))
_FULL = 0.6
"""Share of the columns that a row of headings fills at least."""


@dataclass(frozen=True)
class GridLayout:
    """Row indices of a grid. headings: None where there are none. units: of a row of units below them."""

    headings: int | None
    units: int | None
    first: int


def is_number(cell: object) -> bool:
    """Whether a cell holds a number, in whatever decimal sign, or the mark of a gap."""
    if isinstance(cell, bool) or cell is None:
        return False
    if isinstance(cell, int | float):
        return True
    text = str(cell)
    return bool(_NUMBER_CELL.fullmatch(text)) or text.strip().lower() in _GAP


def grid_layout(rows: Sequence[GridRow]) -> GridLayout | None:
    """Headings, units and the first sample; None for a grid without samples.

    The samples begin with the first of `NUMBER_ROWS` rows of equally many numbers, or of all rows that are
    left. The headings are the first row above them that fills most of their columns; a row of units may
    stand below it.
    """
    first = next((i for i in range(len(rows)) if _begins(rows, i)), None)
    if first is None:
        return None
    width = len(_filled(rows[first]))
    wide = [i for i in range(first) if len(_filled(rows[i])) >= max(2, _FULL * width)]
    heading = next((i for i in wide if not _units(rows[i])), None)
    units = next((i for i in wide if heading is not None and i > heading and _units(rows[i])), None)
    top = max((i for i in (heading, units) if i is not None), default=first - 1) + 1
    # A bad cell among the first samples is told later, not lost with the rows before it.
    while first > top and _mostly_numbers(rows[first - 1]):
        first -= 1
    return GridLayout(heading, units, first)


def _begins(rows: Sequence[GridRow], at: int) -> bool:
    block = rows[at : at + NUMBER_ROWS]
    return all(_numbers(row) for row in block) and len({len(_filled(row)) for row in block}) <= 2


def _numbers(row: GridRow) -> bool:
    filled = _filled(row)
    return len(filled) >= 2 and all(is_number(c) for c in filled)


def _mostly_numbers(row: GridRow) -> bool:
    filled = _filled(row)
    return len(filled) >= 2 and sum(map(is_number, filled)) >= _FULL * len(filled)


def _filled(row: GridRow) -> list[object]:
    return [c for c in row if c is not None and str(c).strip()]


def _units(row: GridRow) -> bool:
    filled = [str(c) for c in _filled(row)]
    return sum(is_unit(c) for c in filled) >= _FULL * len(filled)
