"""Exact sensitivities of mean and half-width curves, the mean ones referred to static as the curves are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.curves import ANGLES, RESPONSE_UNITS, SIDES, TYRE_LOAD
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.curve_set import mean_and_half_width, rising
from doe_kc.solver.result import CaseSolution, Solution
from doe_kc.solver.sensitivity import Sensitivities, sensitivities


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
    return gradients_of(solution, exact if exact is not None else sensitivities(axle, solution, paths))


def gradients_of(solution: Solution, sensitivity: Sensitivities) -> CurveGradients:
    """Derivatives of every curve from those of every equilibrium."""
    static = {
        name: np.array([sensitivity.static[solution.column(f"{name}@{side}")] for side in SIDES])
        for name in ANGLES
    }
    cases = {
        ident: _case(solution, case, sensitivity.branches[ident]) for ident, case in solution.cases.items()
    }
    inputs = {ident: rising(case) for ident, case in solution.cases.items()}
    half = {
        ident: _half_widths(solution, case, sensitivity.branches[ident])
        for ident, case in solution.cases.items()
        if is_loop(case.branches)
    }
    return CurveGradients(sensitivity.paths, inputs, cases, static, half)


def _case(solution: Solution, case: CaseSolution, branches: tuple[FloatArray, ...]) -> dict[str, FloatArray]:
    mean, _ = mean_and_half_width(case, list(branches))
    zero = int(np.argmin(np.abs(rising(case))))
    out = {}
    for response in RESPONSE_UNITS:
        columns = [solution.column(f"{response}@{side}") for side in SIDES]
        curve = mean[:, columns].transpose(1, 0, 2)
        out[response] = curve if response == TYRE_LOAD else curve - curve[:, zero : zero + 1]
    return out


def _half_widths(
    solution: Solution, case: CaseSolution, branches: tuple[FloatArray, ...]
) -> dict[str, FloatArray]:
    _, half = mean_and_half_width(case, list(branches))
    return {
        response: half[:, [solution.column(f"{response}@{side}") for side in SIDES]].transpose(1, 0, 2)
        for response in RESPONSE_UNITS
    }


def interpolated(wanted: FloatArray, grid: FloatArray, rows: FloatArray) -> FloatArray:
    """(m, p) rows (n, p) on `grid`, linear between its points."""
    right = np.clip(np.searchsorted(grid, wanted), 1, grid.size - 1)
    share = (wanted - grid[right - 1]) / (grid[right] - grid[right - 1])
    return np.asarray(rows[right - 1] + share[:, None] * (rows[right] - rows[right - 1]))
