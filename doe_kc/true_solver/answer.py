"""Reads what an outside solver wrote: characteristics, and curves in the tidy format of `simulate --out`."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from doe_kc.axle.model import Axle
from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import CurveSet
from doe_kc.ground.errors import nearest
from doe_kc.ground.typing import FloatArray
from doe_kc.true_solver.tidy_curves import Unreadable, curves_from_frame

__all__ = ["Unreadable", "read_characteristics", "read_curves"]


def read_curves(
    file: Path, axle: Axle, load_cases: Iterable[str], windows: Mapping[str, float]
) -> CurveSet | None:
    """Curves of a curves.csv, None when there is no such file; Unreadable names what is wrong with it."""
    if not file.exists():
        return None
    frame = _frame(file)
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
