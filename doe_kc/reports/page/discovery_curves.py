"""Measured curves beside the models with and without the effect, and how large each gap is."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from doe_kc.curves import RESPONSE_LABELS, RESPONSE_UNITS, RIG_RESPONSES, response_name
from doe_kc.discovery.result import Discovery
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.reports.discovery.curves import ModelView, model_names, model_views, worst_views
from doe_kc.reports.discovery.gaps import MODEL_COLOURS
from doe_kc.reports.discovery.tables import gap_table
from doe_kc.reports.discovery.words import MODEL_LABELS
from doe_kc.reports.names import response_axis
from doe_kc.reports.page.curves import ShownModel, curves_html
from doe_kc.reports.render.page import Section, table_html

DISCOVERY_CURVES_LEAD = (
    "Angles and wheel centre are changes from static; the half-width of a loop is (falling − rising) / 2. "
    "The band is ±2 sd of the noise."
)
GAP_WORDS = "Model minus measured as a multiple of the noise of the rig; 1 is noise."
OTHER_EFFECT_WORDS = (
    " The best other effect is fitted in the place of the one found: what it closes as well does not speak "
    "for a name."
)
PREFIX = "effect-curves"
DISCOVERY_MODELS = (
    ShownModel("nominal", MODEL_LABELS["nominal"], MODEL_COLOURS["nominal"], "2 3", shown=False),
    ShownModel("best_decoy", MODEL_LABELS["best_decoy"], MODEL_COLOURS["best_decoy"], "3 3", shown=False),
    ShownModel("tuned", MODEL_LABELS["tuned"], MODEL_COLOURS["tuned"], "7 4"),
    ShownModel("with_effect", MODEL_LABELS["with_effect"], MODEL_COLOURS["with_effect"]),
)


def curves_section(discovery: Discovery) -> list[Section]:
    """One chart for all load cases and responses, the worst one first."""
    views = model_views(discovery)
    if not views:
        return []
    present = model_names(discovery)
    models = [m for m in DISCOVERY_MODELS if m.id in present]
    first = worst_views(discovery)[0].view
    cases = dict.fromkeys([first.load_case, *(v.load_case for v in views.values())])
    keys = dict.fromkeys([_key(first), *(k for r in RIG_RESPONSES for k in (r, f"{r}:loop"))])
    there = {_key(v) for v in views.values()}
    data = {c: _case(c, [v for v in views.values() if v.load_case == c], models) for c in cases}
    responses = {k: _response(k) for k in keys if k in there}
    html = curves_html(PREFIX, data, responses, models)
    return [Section("Curves with and without the effect", html, DISCOVERY_CURVES_LEAD)]


def _key(view: ModelView) -> str:
    return view.response if view.branches == "mean" else f"{view.response}:loop"


def _response(key: str) -> dict[str, str]:
    response, _, loop = key.partition(":")
    unit = RESPONSE_UNITS[response]
    if loop:
        name = f"{response_name(response)}, half-width of the loop"
        return {"label": name[0].upper() + name[1:], "axis": f"{name} [{unit}]", "unit": unit}
    return {"label": RESPONSE_LABELS[response], "axis": response_axis(response), "unit": unit}


def _case(case: str, views: list[ModelView], models: list[ShownModel]) -> dict[str, Any]:
    loops = {v.response: v for v in views if v.branches == "half_width"}
    out: dict[str, Any] = {
        "label": case_label(case),
        "input": views[0].input_label,
        "unit": views[0].input_label.rpartition("[")[2].rstrip("]"),
        "x": {_key(v): v.input for v in views},
        "measured": {
            "y": {_key(v): _short(v.measured) for v in views},
            "sd": {_key(v): _short(v.sd, 1e-3) for v in views},
            "half": {_key(v): _short(_half(v, loops), 1e-3) for v in views},
        },
        "rms": {_key(v): [[float(v.rms(m.id)[side]) for m in models] for side in (0, 1)] for v in views},
    }
    for model in models:
        out[model.id] = {"y": {_key(v): _short(v.models[model.id]) for v in views}}
    return out


def _short(values: FloatArray, share: float = 1e-5) -> FloatArray:
    """Rounded to that share of the largest, or finer: digits that nobody sees make a page slow to mail."""
    largest = float(np.abs(values).max(initial=0.0))
    return values if largest == 0.0 else np.round(values, -math.floor(math.log10(share * largest)))


def _half(view: ModelView, loops: dict[str, ModelView]) -> FloatArray:
    """(2, n) distance of the branches from a mean curve; none from a half-width."""
    loop = loops.get(view.response)
    if view.branches == "half_width" or loop is None:
        return np.zeros_like(view.measured)
    return np.array([np.interp(view.input, loop.input, m) for m in loop.measured])


def gap_section(discovery: Discovery) -> Section:
    """A row a load case and response; without a column for another effect where none was fitted."""
    table, words = gap_table(discovery), GAP_WORDS + OTHER_EFFECT_WORDS
    if not math.isfinite(discovery.gap.best_decoy):
        table, words = table.without("best_decoy"), GAP_WORDS
    return Section("Deviation of every curve", table_html(table), words)
