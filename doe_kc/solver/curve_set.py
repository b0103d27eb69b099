"""From equilibria to curves: mean and half-width on a rising input grid, changes from static."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from doe_kc.axle.topology import TOPOLOGY_CACHE
from doe_kc.curves import ANGLES, RESPONSE_UNITS, SIDES, TYRE_LOAD, CaseCurves, CurveBatch, CurveSet
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase
from doe_kc.solver.batch_suite import BatchSolution
from doe_kc.solver.result import CaseSolution, Solution


def rising(case: CaseSolution) -> FloatArray:
    """(n,) inputs of a load case, rising, each once."""
    return _rising({b.name: b.input for b in case.branches})


def _rising(inputs: Mapping[str, FloatArray]) -> FloatArray:
    if "load" in inputs:
        return inputs["load"]
    return np.concatenate([inputs["neg"][:0:-1], inputs["pos"]])


def mean_and_half_width(case: CaseSolution, values: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Mean of the falling and rising branch and half their difference, on `rising(case)`.

    values: one array per branch of `case`, rows as in its input, any further axes.
    """
    return _folded({b.name: v for b, v in zip(case.branches, values, strict=True)})


def _folded(by_name: Mapping[str, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Mean and half the difference by branch name, over rising inputs."""
    if "load" in by_name:
        falling, climbing = by_name["unload"][::-1], by_name["load"]
        return (falling + climbing) / 2.0, (falling - climbing) / 2.0
    both = np.concatenate([by_name["neg"][:0:-1], by_name["pos"]])
    return both, np.zeros_like(both)


def case_curves(solution: Solution, case: CaseSolution) -> CaseCurves:
    """Curves of one load case; angles and wheel centre are changes from the mean curve at input 0."""
    grid = rising(case)
    mean, half = mean_and_half_width(case, [b.y for b in case.branches])
    columns = _response_columns(solution.output_names)
    shape = (len(RESPONSE_UNITS), len(SIDES), grid.size)
    absolute, halves = mean[:, columns].T.reshape(shape), half[:, columns].T.reshape(shape)
    return _case(case.load_case, grid, absolute, halves)


def _case(load_case: LoadCase, grid: FloatArray, absolute: FloatArray, halves: FloatArray) -> CaseCurves:
    """absolute, halves: (responses, sides, ..., n)."""
    zero = int(np.argmin(np.abs(grid)))
    changes = absolute - absolute[..., zero : zero + 1]
    means = {
        response: absolute[i] if response == TYRE_LOAD else changes[i]
        for i, response in enumerate(RESPONSE_UNITS)
    }
    return CaseCurves(
        load_case.id, load_case.unit, grid, means, dict(zip(RESPONSE_UNITS, halves, strict=True))
    )


def curve_batch(solution: BatchSolution) -> CurveBatch:
    """Curves of every load case and design; those of failed designs hold nothing."""
    shape = (len(RESPONSE_UNITS), len(SIDES), len(solution.failed))
    at_rest = solution.static.T.reshape(shape)
    static = {name: at_rest[i] for i, name in enumerate(RESPONSE_UNITS) if name in ANGLES}
    cases = {}
    for ident, (load_case, branches) in solution.cases.items():
        grid = _rising({b.name: b.input for b in branches})
        both = _folded({b.name: b.y.transpose(1, 2, 0) for b in branches})
        mean, half = (a.transpose(1, 2, 0).reshape(*shape, len(grid)) for a in both)
        cases[ident] = _case(load_case, grid, mean, half)
    return CurveBatch(solution.axle_name, cases, static, solution.half_track[:, None])


@lru_cache(maxsize=TOPOLOGY_CACHE)
def _response_columns(output_names: tuple[str, ...]) -> list[int]:
    """Columns of the curves' responses, left and right."""
    return [output_names.index(f"{response}@{side}") for response in RESPONSE_UNITS for side in SIDES]


def curve_set(solution: Solution) -> CurveSet:
    """Curves of every solved load case, with the static angles; ValueError without a static state."""
    if solution.static is None:
        raise ValueError("the axle has no static state, so it has no curves")
    static = {
        name: solution.static.y[[solution.column(f"{name}@{side}") for side in ("L", "R")]] for name in ANGLES
    }
    cases = {ident: case_curves(solution, case) for ident, case in solution.cases.items()}
    return CurveSet(solution.axle_name, cases, static, solution.half_track)
