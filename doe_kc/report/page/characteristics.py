"""The characteristics as a table with their DNA bars (thesis, Appendix D)."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from markupsafe import Markup

from doe_kc.correlation.result import Correlation
from doe_kc.report.correlation_characteristics import CharacteristicRow, characteristic_table
from doe_kc.report.correlation_dna import DNA_REACH
from doe_kc.report.render.page import Section, render, significant, table_html
from doe_kc.report.table import Column, PageCell

BAR_WIDTH = 230
"""Units across a bar's drawing."""
CHARACTERISTICS_LEAD = (
    "Values normalised to their target: 1 is the target, the grey band the constraint interval (dotted where "
    "it is no constraint); arrows point to values beyond the axis. 100 % = target met, 0 % = as far off as "
    "the baseline. Near zero the measure of the interval, sqrt(target² + 0.005), stands in for the target."
)


def characteristics_section(correlation: Correlation) -> Section:
    """One row a characteristic, sortable and filterable."""
    table = characteristic_table(correlation)
    table = replace(table, columns=(*table.columns, _bar_column()))
    html = table_html(table, notice=render("characteristics_key.html"))
    return Section("Characteristics", html, CHARACTERISTICS_LEAD)


def place(normalized: float) -> float:
    """Unit across the drawing of a normalised value, cut off at its ends."""
    share = (normalized - 1.0 + DNA_REACH) / (2.0 * DNA_REACH)
    return 10.0 + min(max(share, 0.0), 1.0) * (BAR_WIDTH - 20.0)


def bar(row: CharacteristicRow) -> Markup:
    """The drawing of one row."""
    entry = row.entry
    low, high = sorted(place(row.normalized(v)) for v in row.interval)
    values: dict[str, Any] = {"low": low, "high": high, "target": place(1.0), "width": BAR_WIDTH}
    for name, value in (("baseline", entry.baseline), ("final", entry.final)):
        at = row.normalized(value)
        known = math.isfinite(at)
        values[name] = {
            "x": place(at) if known else place(1.0),
            "known": known,
            "beyond": 0 if not known or abs(at - 1.0) <= DNA_REACH else 1 if at > 1.0 else -1,
        }
    words = (
        f"{row.load_case}, {row.label}: target {significant(entry.target.value)}, baseline "
        f"{significant(entry.baseline)}, final {significant(entry.final)} {row.unit}"
    )
    return render("bar.svg", **values, row=row, words=words)


def _bar_column() -> Column[CharacteristicRow]:
    """Baseline and final value beside the interval, sorted by the distance from the target."""
    scale = render("bar_scale.html", reach=DNA_REACH, width=BAR_WIDTH, place=place)
    cell = PageCell(scale, text=bar, order=_off_target)
    return Column("bar", None, _off_target, csv=False, page=cell)


def _off_target(row: CharacteristicRow) -> float:
    return abs(row.normalized(row.entry.final) - 1.0)
