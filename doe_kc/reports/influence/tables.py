"""The tables of an influence study: relations between parameters and characteristics, and the selection."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from doe_kc.load_cases import case_label
from doe_kc.parameter_influence.relations import (
    STRONG_PERCENT,
    CharacteristicLinks,
    ParameterLinks,
    Relations,
    Together,
)
from doe_kc.parameter_influence.selection_result import CharacteristicForecast, Selection, VariableAdvice
from doe_kc.reports.table import Column, Row, SheetLayout, Table, TerminalCell, Value

IMITATED = 1e6
"""Collinearity from which the other variables can imitate one."""
RANK_WIDTH = 40.0
"""Characters of the columns of what is strongest."""


def characteristic_links_table(relations: Relations) -> Table[CharacteristicLinks]:
    """The strongest parameters of each characteristic."""

    def links(row: CharacteristicLinks) -> list[str]:
        return [f"{k.parameter}  {k.percent:+.0f} %" for k in row.links]

    columns: tuple[Column[CharacteristicLinks], ...] = (
        Column("load_case", "Load case", lambda e: case_label(e.characteristic.load_case), width=25),
        Column("characteristic", "Characteristic", lambda e: e.characteristic.label, width=40),
        Column("unit", "Unit", lambda e: e.characteristic.unit, width=9),
        *(_ranked(k, links) for k in range(relations.longest)),
    )
    return Table(
        "Relations",
        f"Entries of {STRONG_PERCENT:g} % and more of the column's largest, strongest first; "
        "+ = both grow together.",
        columns,
        relations.by_characteristic,
        sheet=SheetLayout(frozen="rank_1" if relations.longest else ""),
    )


STRONGEST_NAMED = 4
"""Parameters of a characteristic that a terminal names."""


def strongest_table(relations: Relations) -> Table[CharacteristicLinks]:
    """A line a characteristic with its strongest parameters, for a terminal."""

    def strongest(row: CharacteristicLinks) -> str:
        return ", ".join(f"{k.parameter} {k.percent:+.0f}" for k in row.links[:STRONGEST_NAMED])

    columns: tuple[Column[CharacteristicLinks], ...] = (
        Column("characteristic", "Characteristic", lambda e: e.characteristic.id,
               terminal=TerminalCell("characteristic", "32")),
        Column("strongest", "Strongest parameters", strongest,
               terminal=TerminalCell("strongest parameters, percent of the strongest")),
    )  # fmt: skip
    return Table("Strongest parameters", "", columns, relations.by_characteristic)


def together_table(relations: Relations) -> Table[Together]:
    """Characteristics that move together."""

    def members(row: Together) -> list[str]:
        pairs = zip(row.characteristics, row.signs, strict=True)
        return [name if sign > 0 else f"{name} (opposite)" for name, sign in pairs]

    columns: tuple[Column[Together], ...] = (
        Column("correlation", "Correlation", lambda g: f"|r| of {g.weakest:.3f} and more"),
        Column("gap_1", "", lambda g: ""),
        Column("gap_2", "", lambda g: ""),
        *(_ranked(k, members) for k in range(relations.longest)),
    )
    return Table("Characteristics that move together", "", columns, relations.together)


def parameter_links_table(relations: Relations) -> Table[ParameterLinks]:
    """What each parameter moves most; those that move nothing are left out."""

    def links(row: ParameterLinks) -> list[str]:
        return [f"{k.characteristic}  {k.percent:+.0f} %" for k in row.links]

    columns: tuple[Column[ParameterLinks], ...] = (
        Column("path", "Path", lambda e: e.parameter.path),
        Column("parameter", "Parameter", lambda e: e.parameter.label),
        Column("unit", "Unit", lambda e: e.parameter.unit),
        *(_ranked(k, links) for k in range(relations.longest)),
    )
    rows = [e for e in relations.by_parameter if e.links]
    return Table("What each parameter moves most", "", columns, rows)


def _ranked(k: int, words: Callable[[Row], Sequence[str]]) -> Column[Row]:
    """The k-th of the words of a row, nothing where it has fewer."""

    def word(row: Row) -> Value:
        of = words(row)
        return of[k] if k < len(of) else None

    return Column(f"rank_{k + 1}", f"{k + 1}.", word, width=RANK_WIDTH)


ADVICE_COLUMNS: tuple[Column[VariableAdvice], ...] = (
    Column("order", "Order", lambda v: v.pivot, width=7),
    Column("path", "Path", lambda v: v.parameter.path, width=32),
    Column("verdict", "Verdict", lambda v: v.verdict, width=34),
    Column("influence", "Influence, sd", lambda v: v.influence, "0.000", 13),
    Column("strongest", "Moves most", lambda v: v.strongest, width=32),
    Column("collinearity", "Collinearity", lambda v: v.collinearity, "0.000", 13,
           words=lambda v: v.collinearity if v.collinearity < IMITATED else "imitated"),
    Column("partner", "Most alike", lambda v: v.partner, width=18),
    Column("posterior_ratio", "sd after / before", lambda v: v.posterior_ratio, "0.000", 16),
    Column("unit", "Unit", lambda v: v.parameter.unit),
    Column("nominal", "Nominal", lambda v: v.parameter.nominal, "0.000"),
    Column("move", "Expected move", lambda v: v.move, "0.000", 15),
    Column("expected", "Expected value", lambda v: v.parameter.nominal + v.move, "0.000", 15),
    Column("lower", "Lower", lambda v: v.lower, "0.000"),
    Column("upper", "Upper", lambda v: v.upper, "0.000"),
    Column("note", "Note", lambda v: _bound_words(v), width=44),
)  # fmt: skip
FORECAST_COLUMNS: tuple[Column[CharacteristicForecast], ...] = (
    Column("gap", "", lambda o: ""),
    Column("characteristic", "Characteristic", lambda o: o.characteristic),
    Column("unit", "Unit", lambda o: o.unit),
    Column("baseline", "Baseline", lambda o: o.baseline, "0.0000"),
    Column("target", "Target", lambda o: o.target, "0.0000"),
    Column("sd", "sd", lambda o: o.sd, "0.0000"),
    Column("expected", "Expected", lambda o: o.expected, "0.0000"),
    Column("before", "Before, sd", lambda o: o.before, "0.0000"),
    Column("after", "After, sd", lambda o: o.after, "0.0000"),
)


def selection_table(selection: Selection) -> Table[VariableAdvice]:
    """Verdict, expected move and bounds of every variable."""
    used = sum(v.used for v in selection.variables)
    bound = sum(bool(v.at_bound) for v in selection.variables)
    return Table(
        "Selection",
        f"{used} of {len(selection.variables)} variables to use, {bound} of them at a bound; rank "
        f"{selection.rank}, {selection.informed} directions known better than before, "
        f"condition of the used ones {selection.condition:.3g}.",
        ADVICE_COLUMNS,
        selection.variables,
        title="Selection of variables",
        flagged=lambda v: bool(v.at_bound),
        sheet=SheetLayout(frozen="verdict", single=True),
    )


def forecast_table(selection: Selection) -> Table[CharacteristicForecast]:
    """Every characteristic with the expected moves."""
    return Table("Forecast with these moves (linear)", "", FORECAST_COLUMNS, selection.outcomes)


def _bound_words(advice: VariableAdvice) -> str:
    if not advice.at_bound:
        return ""
    return f"move ends at the {advice.at_bound} bound" + ("; bound widened" if advice.widened else "")
