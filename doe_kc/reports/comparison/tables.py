"""The tables of a comparison: characteristics beside their targets, and the deviations of the curves."""

from __future__ import annotations

from doe_kc.curves import RESPONSE_UNITS, response_name
from doe_kc.ground.numbers import at_sd, with_sd
from doe_kc.load_cases import case_label
from doe_kc.reports.table import Column, PageCell, PageLayout, Table, TerminalCell
from doe_kc.targets.comparison import CharacteristicComparison, Comparison, CurveComparison

COMPARED_CHARACTERISTIC_COLUMNS: tuple[Column[CharacteristicComparison], ...] = (
    Column("name", "Id", lambda c: c.entry.id, json="name", terminal=TerminalCell("characteristic", "34")),
    Column("label", "Characteristic", lambda c: c.entry.label, json="label",
           page=PageCell(style="first wrap", attributes=lambda c: {"title": c.entry.id})),
    Column("load_case", "Load case", lambda c: c.entry.load_case, json="load_case",
           page=PageCell(text=lambda c: case_label(c.entry.load_case))),
    Column("unit", "Unit", lambda c: c.entry.unit, json="unit", page=PageCell()),
    Column("model", "Model", lambda c: c.value, "0.0000", json="model",
           page=PageCell(text=lambda c: at_sd(c.value, c.target_sd), strong=lambda c: True),
           terminal=TerminalCell("model", ">12", ".5g")),
    Column("target", "Target", lambda c: c.target, "0.0000", json="target",
           page=PageCell("Measured ± sd", text=lambda c: with_sd(c.target, c.target_sd)),
           terminal=TerminalCell("target", ">12", ".5g")),
    Column("target_sd", "Target sd", lambda c: c.target_sd, "0.0000", json="target_sd"),
    Column("difference", "Difference", lambda c: c.difference, "0.0000", json="difference",
           page=PageCell(text=lambda c: at_sd(c.difference, c.target_sd)),
           terminal=TerminalCell("difference", ">12", ".3g")),
    Column("low", "Low", lambda c: c.low, "0.0000", json="low",
           page=PageCell(text=lambda c: at_sd(c.low, c.target_sd))),
    Column("high", "High", lambda c: c.high, "0.0000", json="high",
           page=PageCell(text=lambda c: at_sd(c.high, c.target_sd))),
    Column("inside", "Inside", lambda c: c.inside, json="inside", page=PageCell(
        attributes=lambda c: {"class": "" if c.inside else "flag"})),
    Column("marked_unit", None, lambda c: c.entry.unit, csv=False,
           terminal=TerminalCell("  unit", text=lambda c: f" {' ' if c.inside else '*'}{c.entry.unit}")),
)  # fmt: skip
COMPARED_CURVE_COLUMNS: tuple[Column[CurveComparison], ...] = (
    Column("load_case", "Load case", lambda c: c.load_case, json="load_case",
           page=PageCell(style="first", text=lambda c: case_label(c.load_case))),
    Column("response", "Response", lambda c: c.response, json="response",
           page=PageCell(text=lambda c: response_name(c.response))),
    Column("unit", "Unit", lambda c: RESPONSE_UNITS[c.response], json="unit", page=PageCell()),
    Column("side", "Side", lambda c: c.side, json="side", page=PageCell()),
    Column("rms", "RMS", lambda c: c.rms, "0.0000", json="rms",
           page=PageCell("Deviation of the mean curve, RMS", digits=3)),
    Column("rms_half_width", "RMS of the half-width", lambda c: c.rms_half_width, "0.0000",
           json="rms_half_width", page=PageCell("of the loop's half-width, RMS", digits=3)),
    Column("span", "Span", lambda c: c.span, "0.0000", json="span",
           page=PageCell("Range of the measured curve", digits=3)),
)  # fmt: skip


def compared_characteristic_table(comparison: Comparison) -> Table[CharacteristicComparison]:
    """One row a characteristic: model, target, difference, constraint interval."""
    remark = "The model beside the measurement; *: outside the constraint interval."
    layout = PageLayout[CharacteristicComparison](
        "compared-characteristics",
        "Characteristics",
        filtered=True,
        choices={"outside": "outside the interval only"},
        tags=lambda c: "" if c.inside else "outside",
    )
    return Table(
        "Characteristics", remark, COMPARED_CHARACTERISTIC_COLUMNS, comparison.characteristics, page=layout
    )


def compared_curve_table(comparison: Comparison) -> Table[CurveComparison]:
    """One row a curve: RMS deviation of mean and half-width, range of the measured one."""
    layout = PageLayout[CurveComparison]("compared-curves", "Deviation of every curve", filtered=True)
    return Table(
        "Curves", "RMS of model minus measured.", COMPARED_CURVE_COLUMNS, comparison.curves, page=layout
    )
