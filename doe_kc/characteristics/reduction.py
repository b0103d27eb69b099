"""From curves to characteristics; one reduction for simulation and measurement."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from doe_kc.characteristics.registry import CHARACTERISTICS, Characteristic
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LOAD_CASES

FEWEST_POINTS = 3
"""Solved points in a fit window below which there is no gradient."""

LEFT_WHEEL = 0


def fit_window(case: CaseCurves, half_width: float | None = None) -> NDArray[np.bool_]:
    """(n,) bool mask of the points with |input| inside the window (default: the load case's own)."""
    limit = half_width if half_width is not None else default_window(case)
    return np.asarray(np.abs(case.input) <= limit * (1.0 + 1e-9))


def default_window(case: CaseCurves) -> float:
    """Half-width of the default window in the unit of `case.input`."""
    if case.load_case == "roll" and case.input_unit == "mm":
        from doe_kc.load_cases.roll import ROLL_TECHNIQUES

        return ROLL_TECHNIQUES["counter_phase"].window
    return LOAD_CASES[case.load_case].window


def pad_travel(case: CaseCurves, half_track: float) -> FloatArray:
    """(n,) vertical travel in mm of the pad under the left wheel in the chassis frame, up +."""
    if case.load_case != "roll":
        return case.input
    if case.input_unit == "mm":
        return -case.input
    return np.asarray(-half_track * np.tan(np.radians(case.input)))


def abscissa(entry: Characteristic, case: CaseCurves, half_track: float) -> FloatArray:
    """(n,) what the gradient is taken over: mm, N or deg."""
    if entry.abscissa == "wheel_travel":
        return np.asarray(case.mean["wc_z"][LEFT_WHEEL])
    if entry.abscissa == "pad_travel":
        return pad_travel(case, half_track)
    return case.input


def slope(x: FloatArray, y: FloatArray) -> float:
    """Slope of the least-squares line y = a + b x."""
    dx = x - x.mean()
    return float(dx @ (y - y.mean()) / (dx @ dx))


def reduce_one(entry: Characteristic, curves: CurveSet, *, window: float | None = None) -> float:
    """Value of one characteristic in its unit; nan when its static value or load case is not there."""
    if entry.kind == "static":
        if curves.static is None or entry.response not in curves.static:
            return float("nan")
        return float(curves.static[entry.response][LEFT_WHEEL])
    case = curves.cases.get(entry.load_case)
    if case is None or entry.response not in case.mean:
        return float("nan")
    if entry.abscissa == "wheel_travel" and "wc_z" not in case.mean:
        return float("nan")
    inside = fit_window(case, window)
    x = abscissa(entry, case, curves.half_track)[inside]
    return entry.scale * slope(x, case.mean[entry.response][LEFT_WHEEL][inside])


def reduce_all(curves: CurveSet, windows: Mapping[str, float] | None = None) -> dict[str, float]:
    """Every registered characteristic by id; windows: load case -> half-width in place of the default."""
    chosen = windows or {}
    out = {
        ident: reduce_one(entry, curves) for ident, entry in CHARACTERISTICS.items() if entry.kind == "static"
    }
    for entries in GRADIENTS:
        out |= _slopes(entries, curves, chosen.get(entries[0].load_case))
    return {ident: out[ident] for ident in CHARACTERISTICS}


def _gradients() -> tuple[tuple[Characteristic, ...], ...]:
    groups = defaultdict[tuple[str, str], list[Characteristic]](list)
    for entry in CHARACTERISTICS.values():
        if entry.kind != "static":
            groups[entry.load_case, entry.abscissa].append(entry)
    return tuple(tuple(entries) for entries in groups.values())


GRADIENTS = _gradients()
"""Registered gradients that are fitted over the same abscissa of the same load case."""


def _slopes(entries: Sequence[Characteristic], curves: CurveSet, window: float | None) -> dict[str, float]:
    """Those of one group of `GRADIENTS`, as `reduce_one` gives them one by one."""
    out = dict.fromkeys((e.id for e in entries), float("nan"))
    case = curves.cases.get(entries[0].load_case)
    if case is None or (entries[0].abscissa == "wheel_travel" and "wc_z" not in case.mean):
        return out
    known = [e for e in entries if e.response in case.mean]
    if not known:
        return out
    inside = fit_window(case, window)
    x = abscissa(entries[0], case, curves.half_track)[inside]
    return out | {e.id: e.scale * slope(x, case.mean[e.response][LEFT_WHEEL][inside]) for e in known}


def reduction_gradient(
    entry: Characteristic, case: CaseCurves, half_track: float, *, window: float | None = None
) -> Mapping[str, FloatArray]:
    """Derivative of a gradient characteristic to the left curves: name -> (n,), zero outside the window.

    With b = Sxy / Sxx: db = sum (dx_i dy_i + (dy_i - 2 b dx_i) dx_i') / Sxx. Names are the response,
    and `wc_z` when the abscissa is the wheel's travel.
    """
    inside = fit_window(case, window)
    x = abscissa(entry, case, half_track)[inside]
    y = case.mean[entry.response][LEFT_WHEEL][inside]
    dx, dy = x - x.mean(), y - y.mean()
    sxx = dx @ dx
    to_y = np.zeros(case.input.size)
    to_y[inside] = entry.scale * dx / sxx
    out = {entry.response: to_y}
    if entry.abscissa == "wheel_travel":
        to_x = np.zeros(case.input.size)
        to_x[inside] = entry.scale * (dy - 2.0 * (dx @ dy) / sxx * dx) / sxx
        out["wc_z"] = out.get("wc_z", 0.0) + to_x
    return out
