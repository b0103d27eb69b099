"""The tables of a discovery: disagreement, gap, load cases held out."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from doe_kc.curves import RESPONSE_LABELS, response_name
from doe_kc.discovery.result import Discovery, Gap
from doe_kc.discovery.verdict.held_out import HeldOut
from doe_kc.load_cases import case_label
from doe_kc.reports.discovery.words import MODEL_LABELS, model_head
from doe_kc.reports.table import (
    NEUTRAL_FILL,
    POSITIVE_FILL,
    Column,
    PageCell,
    PageLayout,
    Scale,
    SheetLayout,
    Table,
    diverging,
)

PRINTED = 40
"""Disagreements that are printed where fewer are beyond noise."""
FULL_COLOUR_LEVEL = 20.0
"""Standard deviations at which the colour of a disagreement is full."""
FULL_COLOUR_GAP = 3.0
"""Gap, in units of noise, at which a cell's colour is full."""


@dataclass(frozen=True)
class DisagreementRow:
    """One contrast; z in standard deviations, nan where re-tuning absorbs it wholly, + = model above.

    z_nominal counts the noise alone; the others what re-tuning cannot absorb; nan without an effect.
    beyond: names of the maps in which noise alone does not explain it.
    """

    load_case: str
    response: str
    shape: str
    wheels: str
    z_nominal: float
    z_tuned: float
    z_with_effect: float
    beyond: str


def disagreement_rows(discovery: Discovery) -> list[DisagreementRow]:
    """Every contrast of the records."""
    after = (
        discovery.residual_map.z
        if discovery.fitted.model.members
        else np.full(len(discovery.residual_map.names), np.nan)
    )
    maps = {
        MODEL_LABELS["nominal"]: discovery.nominal_map,
        MODEL_LABELS["tuned"]: discovery.tuned_map,
        MODEL_LABELS["with_effect"]: discovery.residual_map,
    }
    rows = []
    for i, c in enumerate(discovery.nominal_map.names):
        z = (float(discovery.nominal_map.z[i]), float(discovery.tuned_map.z[i]), float(after[i]))
        beyond = ", ".join(name for name, v in zip(maps, z, strict=True) if abs(v) > maps[name].threshold)
        rows.append(DisagreementRow(c.load_case, c.response, c.shape, c.wheels, z[0], z[1], z[2], beyond))
    return rows


DISAGREEMENT_COLUMNS: tuple[Column[DisagreementRow], ...] = (
    Column("load_case", "Load case", lambda r: r.load_case, width=28,
           words=lambda r: case_label(r.load_case)),
    Column("response", "Response", lambda r: r.response, width=32,
           words=lambda r: RESPONSE_LABELS[r.response]),
    Column("shape", "Shape", lambda r: r.shape, width=14),
    Column("wheels", "Wheels", lambda r: r.wheels, width=18,
           words=lambda r: "both alike" if r.wheels == "both" else "left against right"),
    Column("z_nominal", "z as handed in", lambda r: r.z_nominal, "0.0", 12),
    Column("z_tuned", "z re-tuned", lambda r: r.z_tuned, "0.0", 12),
    Column("z_with_effect", "z with the effect", lambda r: r.z_with_effect, "0.0", 12),
    Column("beyond", "Beyond noise", lambda r: r.beyond, width=30, csv=False),
)  # fmt: skip


def disagreement_table(discovery: Discovery, *, worst_first: bool = False) -> Table[DisagreementRow]:
    """Every contrast of the records with the model. worst_first: those beyond noise before the others, what
    re-tuning explains worst on top; else in the order of the records."""
    rows = disagreement_rows(discovery)
    if worst_first:
        rows = sorted(rows, key=lambda r: (not r.beyond, -np.nan_to_num(abs(r.z_tuned))))
    beyond = sum(bool(r.beyond) for r in rows)
    return Table(
        "Disagreement",
        f"Standard deviations; beyond ±{discovery.tuned_map.threshold:.1f} "
        f"(nominal ±{discovery.nominal_map.threshold:.1f}) "
        "noise alone does not explain it: these rows come first, and are printed. +: model above measured. "
        "Empty: absorbed by re-tuning.",
        DISAGREEMENT_COLUMNS,
        rows,
        colors=(diverging("z_nominal", "z_with_effect", FULL_COLOUR_LEVEL),),
        sheet=SheetLayout(
            frozen="z_nominal",
            printed_to="beyond",
            printed=max(beyond, min(len(rows), PRINTED)),
        ),
    )


@dataclass(frozen=True)
class GapRow:
    """One row; case is empty for all records together."""

    case: str
    response: str
    gap: Gap


def gap_rows(discovery: Discovery) -> list[GapRow]:
    """All records, then load case by load case; without effects the last value is left out."""
    rows = [GapRow("", "", discovery.gap), *(GapRow(g.load_case, g.response, g.gap) for g in discovery.gaps)]
    if discovery.fitted.model.members:
        return rows
    return [GapRow(r.case, r.response, Gap(**{**vars(r.gap), "with_effect": math.nan})) for r in rows]


def _gap_column(key: str) -> Column[GapRow]:
    """The gap of one model, on the page from white at noise to full colour at three times that, or the noise
    floor, which is not there."""

    def value(row: GapRow) -> float:
        return float(getattr(row.gap, key))

    def shade(row: GapRow) -> dict[str, str]:
        return {"style": f"background:rgba(242,162,60,{_share(value(row))})"}

    if key not in MODEL_LABELS:
        return Column(key, "Noise floor", value, "0.00", 13)
    cell = PageCell(layout=".2f", attributes=shade)
    return Column(key, model_head(key), value, "0.00", 13, page=cell)


def _share(value: float) -> float:
    if not math.isfinite(value):
        return 0.0
    return round(0.75 * min(max(math.log(max(value, 1.0)) / math.log(FULL_COLOUR_GAP), 0.0), 1.0), 3)


GAP_COLUMNS: tuple[Column[GapRow], ...] = (
    Column("load_case", "Load case", lambda r: r.case or "all", width=28,
           words=lambda r: case_label(r.case) if r.case else "All",
           page=PageCell(text=lambda r: case_label(r.case) if r.case else "All records", style="first")),
    Column("response", "Response", lambda r: r.response or "all", width=34,
           words=lambda r: RESPONSE_LABELS.get(r.response, "All"),
           page=PageCell(text=lambda r: response_name(r.response) if r.response else "all")),
    *map(_gap_column, (*MODEL_LABELS, "noise_floor")),
)  # fmt: skip


def gap_table(discovery: Discovery) -> Table[GapRow]:
    """Whitened RMS of all records, then of each load case and response; 1 is noise."""
    first = ("load_case", "response", "nominal", "tuned", "best_decoy")
    return Table(
        "Gap",
        "Model minus measured as a multiple of the noise of the rig; 1 is noise. First row: all records.",
        GAP_COLUMNS,
        gap_rows(discovery),
        colors=(Scale("nominal", "best_decoy", ((1, NEUTRAL_FILL), (3, "FCE0BC"), (10, POSITIVE_FILL))),),
        sheet=SheetLayout(frozen="nominal", single=True),
        page=PageLayout("gap-table", "Gap", filtered=True, first=first),
    )


def gain_words(gain: float) -> str:
    """ln predictive density won, with its sign."""
    text = f"{gain:+,.{1 if abs(gain) < 100 else 0}f}".replace(",", " ")
    return text.replace("-0.0", "0.0").replace("+0.0", "0.0").replace("-", "−")


HELD_OUT_COLUMNS: tuple[Column[HeldOut], ...] = (
    Column("load_case", "Load case", lambda h: h.load_case, width=30, words=lambda h: case_label(h.load_case),
           page=PageCell(style="first")),
    Column("rms_tuned", "RMS re-tuned", lambda h: h.tuned.rms, "0.00", 15,
           page=PageCell("Deviation without an effect", layout=".2f")),
    Column("rms_with_effect", "RMS with the effect", lambda h: h.with_effect.rms, "0.00", 15,
           page=PageCell(model_head("with_effect"), layout=".2f", strong=lambda h: True)),
    Column("rms_law_granted", "RMS, law granted", lambda h: h.law_granted.rms, "0.00", 17),
    Column("gain_ln_density", "Gain, ln density", lambda h: h.gain, "0.0", 17,
           page=PageCell("Predicted better", text=lambda h: "yes" if h.gain > 0.0 else "no",
                         attributes=lambda h: {"class": "flag" if h.gain < 0 else "",
                                               "title": f"ln predictive density {gain_words(h.gain)}"})),
)  # fmt: skip


def held_out_table(discovery: Discovery) -> Table[HeldOut]:
    """One row a load case that was left out of the fit; RMS in sd of the prediction, gain in ln density."""
    return Table(
        "Held out",
        "Each load case predicted by models fitted to all others; RMS 1 = as good as predicted.",
        HELD_OUT_COLUMNS,
        discovery.held_out,
        title="Load cases held out",
        empty="No effect was found, so there is nothing to predict better.",
        page=PageLayout("held-out-table", "Load cases held out"),
    )
