"""Order of rows and columns of the influence matrix: as the thesis's Appendix C."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass

from openpyxl.utils import get_column_letter

from doe_kc.characteristics import Characteristic
from doe_kc.load_cases import LOAD_CASES
from doe_kc.parameter_influence.study import Influence

KINEMATICS = ("static", "vertical", "roll", "steer")
COMPLIANCES = ("lateral", "lateral_opposite", "lateral_offset", "drive", "brake")
GROUPS = ("HARDPOINTS", "BUSHINGS", "OTHER")
SECTION_ROW, CASE_ROW, NAME_ROW, BASELINE_ROW, UNIT_ROW, FIRST_MATRIX_ROW = 4, 5, 6, 7, 8, 9
"""Rows: section, load case, characteristic, nominal value, unit (with the filter), first parameter."""
LABELS = 3
"""Columns before the matrix: group, path, step."""


@dataclass(frozen=True)
class Layout:
    """Order of rows and columns in the sheets: indices into the arrays of an `Influence`."""

    rows: tuple[int, ...]
    columns: tuple[int, ...]
    row_breaks: tuple[int, ...]
    column_breaks: tuple[int, ...]

    @property
    def last_row(self) -> int:
        """Sheet row of the last parameter."""
        return FIRST_MATRIX_ROW + len(self.rows) - 1

    @property
    def last_column(self) -> int:
        """Sheet column of the last characteristic."""
        return LABELS + len(self.columns)

    @property
    def area(self) -> str:
        """Sheet range of the matrix."""
        first, last = get_column_letter(LABELS + 1), get_column_letter(self.last_column)
        return f"{first}{FIRST_MATRIX_ROW}:{last}{self.last_row}"


def section(entry: Characteristic) -> str:
    """KINEMATICS or COMPLIANCES, as Appendix C splits the load cases."""
    return "KINEMATICS" if entry.load_case in KINEMATICS else "COMPLIANCES"


def layout(influence: Influence) -> Layout:
    """Columns by load case in the order of Appendix C, rows by group; both otherwise as they come."""
    cases = [c.load_case for c in influence.characteristics]
    order = {name: i for i, name in enumerate(dict.fromkeys((*KINEMATICS, *COMPLIANCES, *LOAD_CASES)))}
    columns = sorted(range(len(cases)), key=lambda j: order.get(cases[j], len(order)))
    groups = [p.group for p in influence.parameters]
    rows = sorted(range(len(groups)), key=lambda i: GROUPS.index(groups[i]))
    return Layout(
        rows=tuple(rows),
        columns=tuple(columns),
        row_breaks=tuple(FIRST_MATRIX_ROW + k for k in _breaks([groups[i] for i in rows])),
        column_breaks=tuple(LABELS + 1 + k for k in _breaks([cases[j] for j in columns])),
    )


def _breaks(names: list[str]) -> list[int]:
    return [k for k, name in enumerate(names) if k == 0 or name != names[k - 1]]


def step_text(influence: Influence, i: int) -> str:
    """`±1 mm`, `±10 %`, or `+0.1` for a parameter at zero that can only be raised."""
    parameter = influence.parameters[i]
    share = 100.0 * parameter.step / abs(parameter.nominal) if parameter.nominal else math.nan
    relative = parameter.unit not in {"mm", "deg"} or parameter.quantity == "radius"
    if relative and math.isfinite(share):
        return f"±{share:.3g} %"
    sign = "+" if parameter.one_sided else "±"
    return f"{sign}{parameter.step:.3g} {parameter.unit}".removesuffix(" -")


def group_steps(influence: Influence) -> dict[str, str]:
    """Group -> step of most of its parameters, of the groups in which at least half have the same."""
    out = {}
    for group in GROUPS:
        steps = [step_text(influence, i) for i, p in enumerate(influence.parameters) if p.group == group]
        for words, count in Counter(steps).most_common(1):
            if 2 * count >= len(steps):
                out[group] = words
    return out
