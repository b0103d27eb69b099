"""Exact sensitivities of mean and half-width curves, and of the characteristics reduced from them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import internal_gradient
from doe_kc.characteristics import CHARACTERISTICS, Characteristic, reduce_one, reduction_gradient
from doe_kc.curves import ANGLES, RESPONSE_UNITS, SIDES, TYRE_LOAD, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import curve_set, mean_and_half_width, rising
from doe_kc.solver.result import CaseSolution, Solution
from doe_kc.solver.sensitivity import Sensitivities, sensitivities

CURVE_OUTPUTS = tuple(f"{response}@{side}" for response in RESPONSE_UNITS for side in SIDES)
"""Outputs that curves are made of, in their order."""


def is_loop(branches: Sequence[object]) -> bool:
    """Whether the branches of a load case are those of a loop with friction, not the two from zero."""
    return len(branches) > 2


@dataclass(frozen=True)
class CurveGradients:
    """Derivatives to p parameters, per unit of each.

    inputs: load case -> (n,). cases: load case -> response -> (2, n, p) of the mean curve.
    static: response -> (2, p), absolute. half_width: as cases; a load case without friction has none.
    """

    paths: tuple[str, ...]
    inputs: Mapping[str, FloatArray]
    cases: Mapping[str, Mapping[str, FloatArray]]
    static: Mapping[str, FloatArray]
    half_width: Mapping[str, Mapping[str, FloatArray]] = field(default_factory=dict)


def curve_gradients(
    axle: Axle, solution: Solution, paths: Sequence[str], exact: Sensitivities | None = None
) -> CurveGradients:
    """Derivatives of every curve of a solution; exact: its sensitivities, where they are known."""
    return gradients_of(solution, exact or sensitivities(axle, solution, paths, outputs=CURVE_OUTPUTS))


def gradients_of(solution: Solution, sensitivity: Sensitivities) -> CurveGradients:
    """Derivatives of every curve from those of every equilibrium."""
    static = {
        name: np.array([sensitivity.static[solution.column(f"{name}@{side}")] for side in SIDES])
        for name in ANGLES
    }
    inputs = {ident: rising(case) for ident, case in solution.cases.items()}
    cases: dict[str, dict[str, FloatArray]] = {}
    half: dict[str, dict[str, FloatArray]] = {}
    for ident, case in solution.cases.items():
        cases[ident], half_width = _case(case, sensitivity.along(ident, CURVE_OUTPUTS))
        if is_loop(case.branches):
            half[ident] = half_width
    return CurveGradients(sensitivity.paths, inputs, cases, static, half)


def _case(
    case: CaseSolution, branches: list[FloatArray]
) -> tuple[dict[str, FloatArray], dict[str, FloatArray]]:
    """Response -> (2, n, p) of the mean curve, and of the half-width. branches: of CURVE_OUTPUTS."""
    both = mean_and_half_width(case, branches)
    places = range(0, len(CURVE_OUTPUTS), len(SIDES))
    mean, half = ([rows[:, i : i + len(SIDES)].transpose(1, 0, 2) for i in places] for rows in both)
    zero = int(np.argmin(np.abs(rising(case))))
    changes = [
        curve if response == TYRE_LOAD else curve - curve[:, zero : zero + 1]
        for response, curve in zip(RESPONSE_UNITS, mean, strict=True)
    ]
    return (
        dict(zip(RESPONSE_UNITS, changes, strict=True)),
        dict(zip(RESPONSE_UNITS, half, strict=True)),
    )


def scaled_gradients(gradients: CurveGradients, factors: Mapping[str, float]) -> CurveGradients:
    """Derivatives of curves that are read by a factor, by response; static angles are read as they are."""
    if not factors:
        return gradients

    def scaled(cases: Mapping[str, Mapping[str, FloatArray]]) -> dict[str, dict[str, FloatArray]]:
        return {i: {r: factors.get(r, 1.0) * g for r, g in case.items()} for i, case in cases.items()}

    return replace(gradients, cases=scaled(gradients.cases), half_width=scaled(gradients.half_width))


def interpolated(wanted: FloatArray, grid: FloatArray, rows: FloatArray) -> FloatArray:
    """(..., m, p) rows (..., n, p) on `grid`, linear between its points."""
    right = np.clip(np.searchsorted(grid, wanted), 1, grid.size - 1)
    share = (wanted - grid[right - 1]) / (grid[right] - grid[right - 1])
    low = rows[..., right - 1, :]
    return np.asarray(low + share[:, None] * (rows[..., right, :] - low))


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
