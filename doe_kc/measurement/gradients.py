"""Gradients at static, in windows of physical input, with the standard errors that the noise implies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_one, reduction_gradient
from doe_kc.characteristics.reduction import LEFT_WHEEL, default_window, fit_window, slope
from doe_kc.curves import RESPONSE_UNITS, SIDES, CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.noise import CaseNoise

Windows = Mapping[str, float]
"""Load case -> half-width of the fit window in the input's unit; missing ones take the default."""


@dataclass(frozen=True)
class Gradient:
    """Slope of the least-squares line through a mean curve over the load-case input.

    value, sd: response unit per input unit (`unit`). intercept: of the line at input 0.
    window: half-width in the input's unit. sd: from the noise model, repeats averaged.
    """

    load_case: str
    response: str
    side: str
    value: float
    sd: float
    intercept: float
    unit: str
    window: float


@dataclass(frozen=True)
class GradientEstimate:
    """A characteristic's value and standard error, both in its unit; nan where it cannot be known."""

    value: float
    sd: float


def window_of(case: CaseCurves, windows: Windows) -> float:
    """Half-width of the fit window of a load case."""
    return windows.get(case.load_case, default_window(case))


def slope_weights(x: FloatArray) -> FloatArray:
    """(n,) weights w with slope = w' y of the least-squares line over x (n,)."""
    dx = x - x.mean()
    out: FloatArray = dx / (dx @ dx)
    return out


def case_gradients(case: CaseCurves, noise: CaseNoise, windows: Windows) -> tuple[Gradient, ...]:
    """Gradients of every response and side of one load case."""
    half_width = window_of(case, windows)
    inside = fit_window(case, half_width)
    x = case.input[inside]
    weights = np.zeros(case.input.size)
    weights[inside] = slope_weights(x)
    out = []
    for response, curve in case.mean.items():
        for side, name in enumerate(SIDES):
            y = curve[side][inside]
            value = slope(x, y)
            variance = float(weights @ noise[response].covariance(side=side) @ weights)
            out.append(
                Gradient(
                    load_case=case.load_case,
                    response=response,
                    side=name,
                    value=value,
                    sd=float(np.sqrt(max(variance, 0.0))),
                    intercept=float(y.mean() - value * x.mean()),
                    unit=f"{RESPONSE_UNITS[response]}/{case.input_unit}",
                    window=half_width,
                )
            )
    return tuple(out)


def characteristic_estimates(
    curves: CurveSet, noise: Mapping[str, CaseNoise], windows: Windows, *, static_sd: Mapping[str, float]
) -> dict[str, GradientEstimate]:
    """Every registered characteristic with its standard error.

    static_sd: static response -> standard deviation of the alignment's angle, deg.
    """
    return {
        ident: _estimate(entry, curves, noise, windows, static_sd) for ident, entry in CHARACTERISTICS.items()
    }


def _estimate(
    entry: Characteristic,
    curves: CurveSet,
    noise: Mapping[str, CaseNoise],
    windows: Windows,
    static_sd: Mapping[str, float],
) -> GradientEstimate:
    window = windows.get(entry.load_case)
    value = reduce_one(entry, curves, window=window)
    if not np.isfinite(value):
        return GradientEstimate(float("nan"), float("nan"))
    if entry.kind == "static":
        return GradientEstimate(value, static_sd[entry.response])
    case = curves.cases[entry.load_case]
    weights = reduction_gradient(entry, case, curves.half_track, window=window)
    models = noise[entry.load_case]
    variance = sum(float(w @ models[r].covariance(side=LEFT_WHEEL) @ w) for r, w in weights.items())
    return GradientEstimate(value, float(np.sqrt(max(variance, 0.0))))
