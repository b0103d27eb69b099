"""The page of an influence study: the matrix as a table, parameters down, characteristics across."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from doe_kc.axle.design_parameters import Parameter
from doe_kc.characteristics import Characteristic
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.parameter_influence.global_sensitivity import GlobalSensitivity
from doe_kc.parameter_influence.study import Influence
from doe_kc.reports.influence.global_figures import global_bars
from doe_kc.reports.influence.global_tables import convergence_table, global_table
from doe_kc.reports.influence.global_words import GLOBAL_LEAD, METHODS_LEAD, global_sentences
from doe_kc.reports.names import within_sentence
from doe_kc.reports.page.axle import png_data
from doe_kc.reports.render.page import Section, render, table_html, write_page
from doe_kc.reports.table import (
    NEGATIVE_FILL,
    NEUTRAL_FILL,
    POSITIVE_FILL,
    Column,
    PageCell,
    PageLayout,
    Table,
)

BLANK_BELOW = 5.0
"""Percent of a column's largest below which a cell stays empty, as in Appendix C of the thesis."""
INFLUENCE_LEAD = (
    "Change of each characteristic by one step of one parameter, as a percentage of the column's largest; "
    "blue: falls, orange: rises as the parameter grows; blank: below 5 %. Steps: 1 mm for hardpoints, 10 % "
    "for stiffnesses; point at a cell for the change in its unit."
)


@dataclass(frozen=True)
class InfluenceRow:
    """percent, absolute: (characteristics,) of the parameter."""

    parameter: Parameter
    percent: FloatArray
    absolute: FloatArray


def influence_table(influence: Influence) -> Table[InfluenceRow]:
    """One row a parameter, in their order."""
    rows = [
        InfluenceRow(p, percent, absolute)
        for p, percent, absolute in zip(
            influence.parameters, influence.percent, influence.absolute, strict=True
        )
    ]
    columns = [_column(i, c) for i, c in enumerate(influence.characteristics)]
    layout = PageLayout[InfluenceRow]("influence-table", "Influence of parameters", filtered=True)
    return Table("Influence", INFLUENCE_LEAD, (*NAME_COLUMNS, *columns), rows, page=layout)


NAME_COLUMNS: tuple[Column[InfluenceRow], ...] = (
    Column("path", "Code", lambda r: r.parameter.path, page=PageCell(style="first")),
    Column("label", "Parameter", lambda r: r.parameter.label, page=PageCell(style="wrap")),
)


def _column(place: int, characteristic: Characteristic) -> Column[InfluenceRow]:
    def percent(row: InfluenceRow) -> float:
        return float(row.percent[place])

    def shown(row: InfluenceRow) -> bool:
        return math.isfinite(percent(row)) and abs(percent(row)) >= BLANK_BELOW

    return Column(
        characteristic.id,
        None,
        percent,
        "0",
        page=PageCell(
            f"{case_label(characteristic.load_case)}: {within_sentence(characteristic.label)}",
            text=lambda r: f"{percent(r):+.0f}" if shown(r) else "",
            fill=lambda r: _fill(percent(r)) if shown(r) else "",
            style="turned",
            attributes=lambda r: {"title": f"{r.absolute[place]:+.3g} {characteristic.unit}"},
        ),
    )


def _fill(percent: float) -> str:
    """Blue at -100, white at 0, orange at 100; RRGGBB between them in proportion."""
    full, share = (NEGATIVE_FILL if percent < 0.0 else POSITIVE_FILL), min(abs(percent) / 100.0, 1.0)
    pairs = [(int(NEUTRAL_FILL[i : i + 2], 16), int(full[i : i + 2], 16)) for i in (0, 2, 4)]
    return "".join(f"{round(low + share * (high - low)):02X}" for low, high in pairs)


def influence_sections(
    influence: Influence, overall: GlobalSensitivity | None = None, study: str = ""
) -> Sequence[Section]:
    """The matrix; then global sensitivities, where there are some."""
    out = [Section("Influence of every parameter", table_html(influence_table(influence)), INFLUENCE_LEAD)]
    if overall is not None:
        sentences = render("tolerance.html", sentences=global_sentences(overall))
        picture = render(
            "picture.html",
            source=png_data(global_bars(overall, study=study)),
            words="Local and global influence of the strongest variables",
            folded=False,
        )
        out += [
            Section("Over the ranges", sentences + picture, GLOBAL_LEAD),
            Section("Global sensitivities", table_html(global_table(overall))),
            Section("Convergence", table_html(convergence_table(overall)), METHODS_LEAD),
        ]
    return out


def write_influence_page(
    path: Path,
    influence: Influence,
    *,
    study: str,
    axle: str,
    date: str,
    labels: Mapping[str, str] | None = None,
    overall: GlobalSensitivity | None = None,
) -> Path:
    """Write the page; RunError when it cannot be written. axle: which one it is of. labels: of its points and
    elements."""
    sections = influence_sections(influence, overall, study)
    return write_page(path, f"Influence: {study}", sections, subtitle=f"{axle}; {date}", labels=labels)
