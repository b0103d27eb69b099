"""From curves to characteristics; one reduction for simulation and measurement."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from doe_kc.characteristics.registry import CHARACTERISTICS, Characteristic
from doe_kc.curves import CaseCurves, CurveBatch, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LOAD_CASES

FEWEST_POINTS = 3
"""Solved points in a fit window below which there is no gradient."""

LEFT_WHEEL = 0
NOTHING = np.array(np.nan)
"""Of a characteristic that the curves do not show."""


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


def pad_travel(case: CaseCurves, half_track: float | FloatArray) -> FloatArray:
    """(n,) vertical travel in mm of the pad under the left wheel in the chassis frame, up +; (d, n) of many
    designs whose half_track is (d, 1)."""
    if case.load_case != "roll":
        return case.input
    if case.input_unit == "mm":
        return -case.input
    return np.asarray(-half_track * np.tan(np.radians(case.input)))


def abscissa(entry: Characteristic, case: CaseCurves, half_track: float | FloatArray) -> FloatArray:
    """(n,) what the gradient is taken over: mm, N or deg; (d, n) of many designs where it is their own."""
    if entry.abscissa == "wheel_travel":
        return np.asarray(case.mean["wc_z"][LEFT_WHEEL])
    if entry.abscissa == "pad_travel":
        return pad_travel(case, half_track)
    return case.input


def slope(x: FloatArray, y: FloatArray) -> float:
    """Slope of the least-squares line y = a + b x."""
    return float(slopes(x, y))


def slopes(x: FloatArray, y: FloatArray) -> FloatArray:
    """The same along the last axis of each, (n,) or (d, n)."""
    dx = x - x.mean(axis=-1, keepdims=True)
    dy = y - y.mean(axis=-1, keepdims=True)
    return np.asarray((dx * dy).sum(axis=-1) / (dx * dx).sum(axis=-1))


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
    return {ident: float(value) for ident, value in _values(curves, windows or {}).items()}


def reduce_batch(curves: CurveBatch, windows: Mapping[str, float] | None = None) -> FloatArray:
    """(d, characteristics) of d designs in the order of the registry; as `reduce_all`."""
    values = _values(curves, windows or {}).values()
    return np.stack([np.broadcast_to(value, len(curves.half_track)) for value in values], axis=1)


def _values(curves: CurveSet | CurveBatch, windows: Mapping[str, float]) -> dict[str, FloatArray]:
    """Id -> scalar, or (d,) of a batch."""
    out: dict[str, FloatArray] = {}
    for entry in CHARACTERISTICS.values():
        if entry.kind == "static":
            known = curves.static is not None and entry.response in curves.static
            out[entry.id] = curves.static[entry.response][LEFT_WHEEL] if curves.static and known else NOTHING
    for entries in GRADIENTS:
        out |= _slopes(entries, curves, windows.get(entries[0].load_case))
    return {ident: out[ident] for ident in CHARACTERISTICS}


def _gradients() -> tuple[tuple[Characteristic, ...], ...]:
    groups = defaultdict[tuple[str, str], list[Characteristic]](list)
    for entry in CHARACTERISTICS.values():
        if entry.kind != "static":
            groups[entry.load_case, entry.abscissa].append(entry)
    return tuple(tuple(entries) for entries in groups.values())


GRADIENTS = _gradients()
"""Registered gradients that are fitted over the same abscissa of the same load case."""


def _slopes(
    entries: Sequence[Characteristic], curves: CurveSet | CurveBatch, window: float | None
) -> dict[str, FloatArray]:
    """Those of one group of `GRADIENTS`, as `reduce_one` gives them one by one."""
    out = dict.fromkeys((e.id for e in entries), NOTHING)
    case = curves.cases.get(entries[0].load_case)
    if case is None or (entries[0].abscissa == "wheel_travel" and "wc_z" not in case.mean):
        return out
    known = [e for e in entries if e.response in case.mean]
    if not known:
        return out
    inside = fit_window(case, window)
    x = abscissa(entries[0], case, curves.half_track)[..., inside]
    return out | {e.id: e.scale * slopes(x, case.mean[e.response][LEFT_WHEEL][..., inside]) for e in known}


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
