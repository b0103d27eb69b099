"""Exact sensitivities of the characteristics: the reduction's derivative applied to those of the curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import internal_gradient
from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_one, reduction_gradient
from doe_kc.curves import CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import curve_set, mean_and_half_width
from doe_kc.solver.result import Solution
from doe_kc.solver.sensitivity import Sensitivities, sensitivities


def characteristic_gradients(
    axle: Axle,
    solution: Solution,
    paths: Sequence[str],
    characteristics: Sequence[Characteristic] | None = None,
    *,
    windows: Mapping[str, float] | None = None,
    exact: Sensitivities | None = None,
) -> FloatArray:
    """(characteristics, paths) derivatives, unit of the characteristic per unit of the parameter.

    characteristics: all registered ones by default; nan for those whose load case was not solved.
    exact: sensitivities of `solution` to `paths`, where they are known.
    """
    entries = list(CHARACTERISTICS.values()) if characteristics is None else characteristics
    gradients = exact if exact is not None else sensitivities(axle, solution, paths)
    curves = curve_set(solution)
    half_track = np.array([_half_track_gradient(axle, path) for path in paths])
    chosen = windows or {}
    return np.array(
        [_one(e, solution, curves, gradients, half_track, chosen.get(e.load_case)) for e in entries]
    )


def _half_track_gradient(axle: Axle, path: str) -> float:
    """d|y of the left wheel centre| / d(path); the internal y is negative."""
    return -internal_gradient(axle, path).get("WLC.y@L", 0.0)


def _one(
    entry: Characteristic,
    solution: Solution,
    curves: CurveSet,
    exact: Sensitivities,
    half_track: FloatArray,
    window: float | None,
) -> FloatArray:
    if entry.kind == "static":
        return np.asarray(exact.static[solution.column(f"{entry.response}@L")])
    if entry.load_case not in solution.cases:
        return np.full(len(exact.paths), np.nan)
    case = curves.cases[entry.load_case]
    means, _ = mean_and_half_width(solution.cases[entry.load_case], list(exact.branches[entry.load_case]))
    gradient = np.zeros(len(exact.paths))
    for name, weight in reduction_gradient(entry, case, curves.half_track, window=window).items():
        gradient += weight @ means[:, solution.column(f"{name}@L")]
    if entry.abscissa == "pad_travel" and entry.load_case == "roll" and case.input_unit == "deg":
        gradient -= reduce_one(entry, curves, window=window) / curves.half_track * half_track
    return gradient
