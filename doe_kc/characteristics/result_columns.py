"""Columns of a table of designs that hold what they gave, beside those of their parameters."""

from __future__ import annotations

from collections.abc import Iterable

from doe_kc.axle.parameter_kinds import KINDS
from doe_kc.characteristics.registry import CHARACTERISTICS

STATUS = "status"
"""Column that every table of evaluated designs has: ok or failed."""
CHARACTERISTIC_RESULTS = tuple(f"result.{name}" if name in KINDS else name for name in CHARACTERISTICS)
"""Their ids, but `result.static.toe`, as `static.toe` is a parameter."""
RESULT_COLUMNS = frozenset({STATUS, "reason", *CHARACTERISTIC_RESULTS, "seconds"})


def design_columns(names: Iterable[str]) -> list[str]:
    """The columns without those of results, where the designs are evaluated ones; else all of them."""
    all_names = list(names)
    if STATUS not in all_names:
        return all_names
    return [name for name in all_names if name not in RESULT_COLUMNS]
