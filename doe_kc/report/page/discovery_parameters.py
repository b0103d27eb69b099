"""Parameters that re-tuning had to bend, and where they go with the effect."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from markupsafe import Markup

from doe_kc.discovery.result import Discovery
from doe_kc.ground.numbers import with_sd
from doe_kc.report.discovery_gaps import MODEL_COLOURS
from doe_kc.report.discovery_parameter_figure import arrow_colour
from doe_kc.report.discovery_parameters import TunedParameter, tuned_table
from doe_kc.report.render.page import Section, render, table_html
from doe_kc.report.table import Column, PageCell

BIAS_LEAD = (
    "Where an effect is missing, re-tuning bends parameters that have nothing to do with it. Circles: "
    "distance from nominal after re-tuning without an effect, in standard deviations of the prior; "
    "arrows lead to the place with the effect."
)
BIAS_REACH, BIAS_WIDTH = 2.5, 200.0
"""Distance at the ends of the drawing, and its width in units."""


def parameters_section(discovery: Discovery) -> Section:
    """One row a tunable parameter, sortable and filterable, those furthest off first."""
    table = tuned_table(discovery)
    rows = sorted(table.rows, key=lambda p: -abs(p.tuned_distance))
    columns = (*table.columns, *_page_columns(bool(discovery.fitted.model.members)))
    html = table_html(replace(table, rows=rows, columns=columns))
    return Section("Parameters with and without the effect", html, BIAS_LEAD)


def _page_columns(has_effect: bool) -> Iterator[Column[TunedParameter]]:
    """The last value with its standard deviation, and the distances as a drawing."""

    def last(p: TunedParameter) -> float:
        return p.with_effect if has_effect else p.tuned

    head = f"{'With effect' if has_effect else 'Re-tuned'} ± sd"
    shown = PageCell[TunedParameter](head, text=lambda p: with_sd(last(p), p.sd), strong=lambda p: True)
    yield Column("last", None, last, "0.0000", csv=False, page=shown)
    drawing = PageCell[TunedParameter](
        "Distance from nominal, ±2.5 sd", text=_bar, order=lambda p: abs(p.tuned_distance)
    )
    yield Column("bar", None, lambda p: p.tuned_distance, csv=False, page=drawing)


def _bar(p: TunedParameter) -> Markup:
    known = math.isfinite(p.with_effect_distance)
    return render(
        "tuned.svg",
        p=p,
        width=BIAS_WIDTH,
        start=_place(p.tuned_distance),
        end=_place(p.with_effect_distance) if known else None,
        colour=arrow_colour(p) if known else "",
        circle=MODEL_COLOURS["tuned"],
    )


def _place(distance: float) -> float:
    """Unit across the drawing, cut off at its ends."""
    share = min(max(distance / BIAS_REACH, -1.0), 1.0)
    return round(0.5 * BIAS_WIDTH * (1.0 + 0.94 * share), 1)
