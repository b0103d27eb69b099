"""Measured, baseline and final curves, to choose, hover and zoom (thesis, Appendix E)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from markupsafe import Markup

from doe_kc.correlation.result import Correlation
from doe_kc.curves import RESPONSE_LABELS, RESPONSE_UNITS, RIG_RESPONSES, CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import case_label
from doe_kc.measurement import Measurement
from doe_kc.reports.correlation.curves import BAND_SDS, CaseView, case_views
from doe_kc.reports.names import input_label, response_axis
from doe_kc.reports.render.page import Section, embedded, render
from doe_kc.targets.comparison import rms_deviation


@dataclass(frozen=True)
class ShownModel:
    """A model's curve: key of its set, name, colour and SVG dash pattern; shown: from the start."""

    id: str
    label: str
    colour: str
    dash: str = ""
    shown: bool = True


CORRELATION_MODELS = (
    ShownModel("baseline", "baseline", "#e69f00", "7 4"),
    ShownModel("final", "final", "#0072b2"),
)
CURVES_LEAD = "Angles and wheel centre are changes from static."


def curves_section(correlation: Correlation, measurement: Measurement | None) -> list[Section]:
    """One chart for all load cases and responses; no section when there is no curve at all."""
    views = case_views(correlation, measurement)
    if not views:
        return []
    cases = {view.load_case: _case(view) for view in views}
    responses = {r: _response(r) for r in RIG_RESPONSES}
    return [Section("Curves", curves_html("curves", cases, responses, CORRELATION_MODELS), CURVES_LEAD)]


def curves_html(
    prefix: str,
    cases: Mapping[str, Mapping[str, Any]],
    responses: Mapping[str, Mapping[str, str]],
    models: Sequence[ShownModel],
) -> Markup:
    """A chart of curves to choose from.

    prefix: of its anchors, one for each chart of a page. cases: id -> label, input, unit, measured (x, y,
    half, sd), a set (x, y) for each model's id, and rms of each side and model; x: for all responses or by
    response, the case's own where a set has none. responses: id -> label, axis, unit.
    """
    shown = [vars(m) for m in models]
    data = {"cases": cases, "responses": responses, "models": shown, "band": BAND_SDS}
    measured = any(case["measured"] for case in cases.values())
    return render(
        "curves.html", prefix=prefix, data=embedded(data), cases=cases, responses=responses, models=models,
        measured=measured,
    )  # fmt: skip


def _response(response: str) -> dict[str, str]:
    return {
        "label": RESPONSE_LABELS[response],
        "axis": response_axis(response),
        "unit": RESPONSE_UNITS[response],
    }


def _case(view: CaseView) -> dict[str, Any]:
    models = {"baseline": view.baseline, "final": view.final}
    return case_data(view.load_case, view.input_label, view.measured, view.sd, models)


def case_data(
    load_case: str,
    label: str,
    measured: CaseCurves | None,
    sd: Mapping[str, FloatArray],
    models: Mapping[str, CaseCurves | None],
) -> dict[str, Any]:
    """A load case of a chart. label: of its input. sd: response -> (2, n) of the measured curve. models: by
    the ids of the chart's; one at least, or a measured curve."""
    units = [c.input_unit for c in (measured, *models.values()) if c is not None]
    return {
        "label": case_label(load_case),
        "input": label,
        "unit": units[0],
        "measured": None if measured is None else _measured(measured, sd),
        **{name: _model(curves) for name, curves in models.items()},
        "rms": {r: _rms(measured, list(models.values()), r) for r in RIG_RESPONSES},
    }


def curve_set_section(
    measured: CurveSet | None,
    sd: Mapping[str, Mapping[str, FloatArray]],
    model: CurveSet | None,
    label: str = "model",
) -> Section:
    """Curves of a model, of the records, or of both. sd: load case -> response -> (2, n)."""
    sets = [s.cases for s in (measured, model) if s is not None]
    models = () if model is None else (replace(CORRELATION_MODELS[1], id="model", label=label),)
    cases = {}
    for name in dict.fromkeys(case for cases_of in sets for case in cases_of):
        rig = measured.cases.get(name) if measured is not None else None
        ours = {} if model is None else {"model": model.cases.get(name)}
        unit = next(c[name].input_unit for c in sets if name in c)
        cases[name] = case_data(name, input_label(name, unit), rig, sd.get(name, {}), ours)
    responses = {r: _response(r) for r in RIG_RESPONSES}
    return Section("Curves", curves_html("curves", cases, responses, models), CURVES_LEAD)


def _model(case: CaseCurves | None) -> dict[str, Any] | None:
    if case is None:
        return None
    return {"x": case.input, "y": {r: case.mean[r] for r in RIG_RESPONSES if r in case.mean}}


def _measured(case: CaseCurves, sd: Mapping[str, FloatArray]) -> dict[str, Any]:
    present = [r for r in RIG_RESPONSES if r in case.mean]
    nothing = np.zeros((2, case.input.size))
    return {
        "x": case.input,
        "y": {r: case.mean[r] for r in present},
        "half": {r: case.half_width[r] for r in present},
        "sd": {r: sd.get(r, nothing) for r in present},
    }


def _rms(
    rig: CaseCurves | None, models: Sequence[CaseCurves | None], response: str
) -> list[list[float | None]]:
    """Of each model, of the left and of the right wheel, where both curves reach."""
    return [[_deviation(rig, c, response, s) for c in models] for s in (0, 1)]


def _deviation(rig: CaseCurves | None, model: CaseCurves | None, response: str, side: int) -> float | None:
    if model is None or rig is None or response not in rig.mean or response not in model.mean:
        return None
    inside = (rig.input >= model.input[0]) & (rig.input <= model.input[-1])
    ours = np.interp(rig.input[inside], model.input, model.mean[response][side])
    return rms_deviation(ours, rig.mean[response][side][inside])
