"""What every table of characteristics says of each: name, load case, response, unit; and their order."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Protocol, TypeVar

from doe_kc.characteristics import Characteristic
from doe_kc.curves import response_name
from doe_kc.load_cases import CASE_ORDER, case_label
from doe_kc.reports.table import Column, PageCell

Value = TypeVar("Value")


class OfCharacteristic(Protocol):
    """A row about one characteristic."""

    @property
    def entry(self) -> Characteristic:
        """Which one."""


CHARACTERISTIC_COLUMNS: tuple[Column[Any], ...] = (
    Column[OfCharacteristic]("name", "Id", lambda r: r.entry.id, width=31,
           page=PageCell("Characteristic", text=lambda r: r.entry.label, style="first",
                         attributes=lambda r: {"title": r.entry.id})),
    Column[OfCharacteristic]("load_case", "Load case", lambda r: r.entry.load_case, width=16,
           json="load_case", page=PageCell(text=lambda r: case_label(r.entry.load_case))),
    Column[OfCharacteristic]("response", "Response", lambda r: r.entry.response,
           page=PageCell(text=lambda r: response_name(r.entry.response))),
    Column[OfCharacteristic]("unit", "Unit", lambda r: r.entry.unit, width=9, json="unit", page=PageCell()),
)  # fmt: skip
"""Of any row that is an `OfCharacteristic`."""


def by_load_case(rows: Iterable[Value], load_case: Callable[[Value], str]) -> list[Value]:
    """Static first, then the load cases in the package's order; within one as they come."""
    order = {name: i for i, name in enumerate(("static", *CASE_ORDER))}
    return sorted(rows, key=lambda row: order.get(load_case(row), len(order)))
