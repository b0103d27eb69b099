"""Reads what an outside solver wrote: characteristics, and curves in the tidy format of `simulate --out`."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from doe_kc.axle.model import Axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.characteristics.reduction import FEWEST_POINTS, default_window
from doe_kc.curves import ANGLES, RESPONSE_UNITS, SIDES, TYRE_LOAD, CaseCurves, CurveSet
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases.roll import ROLL_TECHNIQUES
from doe_kc.true_solver.adams_answer import vertical_frame

ROW_KEYS = ("load_case", "branch", "input", "input_unit", "side")
NEARLY = 1e-9
"""Relative: rounding of numbers that were written as text."""


class Unreadable(Exception):
    """What an outside solver wrote cannot be used; the text says why, to follow the solver's name."""


def curves_from_frame(
    frame: pd.DataFrame, axle: Axle, load_cases: Sequence[str], windows: Mapping[str, float]
) -> CurveSet:
    """Curves of the load cases named, with the static angles at their first point.

    One row a load case, branch (`pos` and `neg`, `unload` and `load`, or one of any name), input and side
    (L, R); angles absolute, wheel centre as it likes, tyre load absolute. Unreadable for anything else.
    """
    columns = _responses(frame)
    for case in load_cases:
        if case not in set(frame["load_case"]):
            raise Unreadable(f"curves.csv has no rows of load case {case}; it is missing or cut off")
    cases, static = {}, None
    for case in load_cases:
        rows = frame[frame["load_case"] == case]
        cases[case], angles = _case(case, rows, columns, axle, windows.get(case))
        static = static or angles
    return CurveSet(axle.name, cases, static or None, axle.half_track)


def _responses(frame: pd.DataFrame) -> dict[str, str]:
    """Response -> column; Unreadable for a missing key or another unit."""
    for key in ROW_KEYS:
        if key not in frame:
            raise Unreadable(f"curves.csv has no column {key!r}")
    out = {name: f"{name}_{unit}" for name, unit in RESPONSE_UNITS.items() if f"{name}_{unit}" in frame}
    units = ("deg", "rad", "mm", "m", "N", "kN")
    for name, unit in RESPONSE_UNITS.items():
        other = [f"{name}_{u}" for u in units if u != unit and f"{name}_{u}" in frame]
        if other:
            raise Unreadable(f"curves.csv: column {other[0]}, expected {name}_{unit}")
    if not out:
        raise Unreadable("curves.csv has no response; expected columns such as toe_deg, wc_y_mm, tyre_load_N")
    return out


def _case(
    case: str, rows: pd.DataFrame, columns: Mapping[str, str], axle: Axle, window: float | None
) -> tuple[CaseCurves, dict[str, FloatArray]]:
    unit = _unit(case, rows, axle)
    columns = {name: column for name, column in columns.items() if rows[column].notna().any()}
    needed = rows[["input", *columns.values()]]
    try:
        numbers = needed.to_numpy(dtype=float)
    except ValueError:
        raise Unreadable(f"curves.csv: load case {case} holds text among its numbers") from None
    bad = np.argwhere(~np.isfinite(numbers))
    if bad.size:
        raise Unreadable(
            f"curves.csv: load case {case}, {needed.columns[bad[0][1]]} is missing or not finite"
        )
    grid, mean, half = _branches(case, rows, columns)
    zero = int(np.argmin(np.abs(grid)))
    static = {name: mean[name][:, zero] for name in ANGLES if name in mean}
    first = _first_point(rows, columns)
    changes = {n: c if n == TYRE_LOAD else c - c[:, zero : zero + 1] for n, c in mean.items()}
    curves = CaseCurves(case, unit, grid, changes, half)
    _check_grid(curves, window)
    return curves, first or static


def _unit(case: str, rows: pd.DataFrame, axle: Axle) -> str:
    known = {axle.load_cases[case].unit} if case in axle.load_cases else set()
    if case == "roll":
        known |= {technique.unit for technique in ROLL_TECHNIQUES.values()}
    units = set(rows["input_unit"])
    if len(units) != 1 or not units <= known:
        given = ", ".join(sorted(map(str, units)))
        raise Unreadable(f"curves.csv: load case {case} has input_unit {given}, expected {min(known)}")
    return str(units.pop())


def _branches(
    case: str, rows: pd.DataFrame, columns: Mapping[str, str]
) -> tuple[FloatArray, dict[str, FloatArray], dict[str, FloatArray]]:
    """Rising grid, mean and half-width of every response, (2, n)."""
    names = set(rows["branch"]) - {"init"}
    if names == {"load", "unload"}:
        grid, up = _sides(case, rows[rows["branch"] == "load"], columns)
        other, down = _sides(case, rows[rows["branch"] == "unload"], columns)
        if other.shape != grid.shape or np.abs(other - grid).max() > NEARLY * np.abs(grid).max():
            raise Unreadable(f"curves.csv: load case {case}: load and unload have other inputs; cut off?")
        mean = {n: (down[n] + up[n]) / 2.0 for n in columns}
        return grid, mean, {n: (down[n] - up[n]) / 2.0 for n in columns}
    if names in ({"pos"}, {"neg"}, {"load"}, {"unload"}):
        raise Unreadable(f"curves.csv: load case {case} has branch {min(names)} alone; cut off?")
    if names != {"pos", "neg"} and len(names) != 1:
        raise Unreadable(f"curves.csv: load case {case} has branches {', '.join(sorted(map(str, names)))}")
    grid, mean = _sides(case, rows[rows["branch"] != "init"], columns)
    return grid, mean, {n: np.zeros_like(c) for n, c in mean.items()}


def _sides(
    case: str, rows: pd.DataFrame, columns: Mapping[str, str]
) -> tuple[FloatArray, dict[str, FloatArray]]:
    tables = []
    for side in SIDES:
        own = rows[rows["side"] == side].drop_duplicates("input").sort_values("input")
        tables.append(own[["input", *columns.values()]].to_numpy(dtype=float))
    left, right = tables
    if len(left) != len(right) or not len(left) or not np.array_equal(left[:, 0], right[:, 0]):
        raise Unreadable(f"curves.csv: load case {case}: sides L and R have other inputs; cut off?")
    values = np.stack([left, right])
    return left[:, 0], {name: values[:, :, 1 + i] for i, name in enumerate(columns)}


def _first_point(rows: pd.DataFrame, columns: Mapping[str, str]) -> dict[str, FloatArray]:
    """Angles at rest, where a loop starts; empty without a branch `init`."""
    start = rows[rows["branch"] == "init"]
    ends = {side: start[start["side"] == side] for side in SIDES}
    if any(table.empty for table in ends.values()):
        return {}
    return {n: np.array([float(ends[s][columns[n]].iloc[0]) for s in SIDES]) for n in ANGLES if n in columns}


def _check_grid(curves: CaseCurves, window: float | None) -> None:
    """Unreadable unless the inputs hold 0, fill the fit window and are enough for a line."""
    limit = window if window is not None else default_window(curves)
    grid, case, unit = curves.input, curves.load_case, curves.input_unit
    inside = np.abs(grid) <= limit * (1.0 + NEARLY)
    if np.abs(grid).min() > NEARLY * np.abs(grid).max():
        raise Unreadable(f"curves.csv: load case {case} has no point at input 0")
    if inside.sum() < FEWEST_POINTS or grid[0] >= 0 or grid[-1] <= 0:
        raise Unreadable(
            f"curves.csv: load case {case} has {inside.sum()} points from {grid[0]:g} to {grid[-1]:g} {unit}"
            f", too few within the fit window of +-{limit:g} {unit}; cut off?"
        )
    if min(-grid[0], grid[-1]) < limit * (1.0 - NEARLY):
        raise Unreadable(
            f"curves.csv: load case {case} ends at {grid[0]:g} and {grid[-1]:g} {unit}, "
            f"inside the fit window of +-{limit:g} {unit}; cut off?"
        )


__all__ = ["Unreadable", "read_characteristics", "read_curves"]


def read_curves(
    file: Path, axle: Axle, load_cases: Iterable[str], windows: Mapping[str, float]
) -> CurveSet | None:
    """Curves of a curves.csv, and of ADAMS's own results of parallel travel beside it; None when there is no
    such file. Unreadable names what is wrong with it."""
    tables = [_frame(file)] if file.exists() else []
    if not tables or "vertical" not in set(tables[0].get("load_case", [])):
        try:
            vertical = vertical_frame(file.parent, axle)
        except InputError as error:
            raise Unreadable(str(error)) from None
        tables += [] if vertical is None else [vertical]
    if not tables:
        return None
    frame = pd.concat(tables, ignore_index=True)
    return curves_from_frame(frame, axle, tuple(load_cases) or tuple(axle.load_cases), windows)


def _frame(file: Path) -> pd.DataFrame:
    try:
        frame = pd.read_csv(file)
    except (ValueError, OSError) as error:  # ValueError: no column at all, rows of unequal length, not UTF-8
        raise Unreadable(f"{file.name} is not a table ({str(error).splitlines()[0]})") from None
    if frame.empty:
        raise Unreadable(f"{file.name} has no row")
    return frame


def read_characteristics(folder: Path) -> FloatArray | None:
    """(n_char,) in the order of the registry, nan where not given; None when there is no file.

    characteristics.csv has the columns name, value, unit; characteristics.json holds
    `{"characteristics": {name: {"value", "unit"}}}`, as `simulate --json` writes it.
    """
    table, document = folder / "characteristics.csv", folder / "characteristics.json"
    if table.exists():
        entries = _from_table(table)
    elif document.exists():
        entries = _from_document(document)
    else:
        return None
    values = {name: _value(name, value, unit) for name, value, unit in entries}
    return np.array([values.get(name, math.nan) for name in CHARACTERISTICS])


def _from_table(file: Path) -> list[tuple[str, object, object]]:
    frame = _frame(file)
    for column in ("name", "value", "unit"):
        if column not in frame:
            raise Unreadable(f"{file.name} has no column {column!r}; expected name, value, unit")
    return [(str(r["name"]), r["value"], r["unit"]) for r in frame.to_dict("records")]


def _from_document(file: Path) -> list[tuple[str, object, object]]:
    try:
        document: Any = json.loads(file.read_text(encoding="utf-8"))
        entries = document.get("characteristics", document)
        return [(str(name), e["value"], e["unit"]) for name, e in entries.items()]
    except (ValueError, OSError, RecursionError) as error:
        raise Unreadable(f"{file.name} is not JSON ({error})") from None
    except (AttributeError, KeyError, TypeError):
        raise Unreadable(
            f'{file.name}: expected {{"characteristics": {{name: {{"value": number, "unit": text}}}}}}'
        ) from None


def _value(name: str, value: object, unit: object) -> float:
    entry = CHARACTERISTICS.get(name)
    if entry is None:
        raise Unreadable(f"characteristic {name!r} is unknown.{nearest(name, CHARACTERISTICS)}")
    if unit != entry.unit:
        raise Unreadable(f"characteristic {name} is in {unit!r}, expected {entry.unit!r}")
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise Unreadable(f"characteristic {name} = {value!r}, expected a finite number")
    return float(value)
