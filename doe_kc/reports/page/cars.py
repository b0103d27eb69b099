"""The section of a page on several measured cars."""

from __future__ import annotations

from collections.abc import Sequence

from doe_kc.reports.comparison.car_table import CAR_REMARK, car_table
from doe_kc.reports.render.page import Section, table_html
from doe_kc.targets.comparison import CarComparison


def cars_section(cars: Sequence[CarComparison]) -> list[Section]:
    """Scatter of the cars and how far the model is from their mean; nothing of one car."""
    return [Section("Cars", table_html(car_table(cars)), CAR_REMARK)] if cars else []
