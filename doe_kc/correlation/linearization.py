"""First-order expansion of everything a model answers, about a point of the space of variables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag

from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import with_values
from doe_kc.ground.typing import FloatArray
from doe_kc.solver import suite
from doe_kc.solver.curve_gradient import (
    CURVE_OUTPUTS,
    CurveGradients,
    characteristic_gradients,
    gradients_of,
    interpolated,
)
from doe_kc.solver.result import Solution
from doe_kc.solver.sensitivity import sensitivities
from doe_kc.targets import CurveTarget
from doe_kc.variables import Space


@dataclass(frozen=True)
class Linearization:
    """Derivatives to the d variables' places u. characteristics: (all registered, d)."""

    characteristics: FloatArray
    curves: CurveGradients


def linearize(
    axle: Axle,
    space: Space,
    point: FloatArray,
    windows: Mapping[str, float] | None = None,
    *,
    solve: Callable[[Axle], Solution] = suite.solve,
) -> Linearization:
    """Exact sensitivities of the axle at `point` (d,), ties followed.

    solve: `suite.solve`, or what gives its solution without solving again.
    NotConverged when the axle has no equilibrium there.
    """
    there = with_values(axle, space.values(point))
    solution = solve(there)
    paths = _moved_paths(space)
    exact = sensitivities(there, solution, paths)
    chain = _chain(space, point)
    slopes = characteristic_gradients(there, solution, paths, windows=windows, exact=exact)
    return Linearization(slopes @ chain, _chained(gradients_of(solution, exact), chain, space.paths))


def linearized_curves(
    there: Axle,
    solution: Solution,
    space: Space,
    point: FloatArray,
    directions: Mapping[str, Mapping[str, float]],
) -> CurveGradients:
    """Curves of the axle at `point` (d,) to first order: d variables, ties followed, then `directions`.

    solution: of that axle. directions: see `sensitivities`.
    """
    exact = sensitivities(there, solution, _moved_paths(space), directions, outputs=CURVE_OUTPUTS)
    chain = block_diag(_chain(space, point), np.eye(len(directions)))
    return _chained(gradients_of(solution, exact), chain, (*space.paths, *directions))


def _moved_paths(space: Space) -> list[str]:
    return [*space.paths, *(tie.follower for tie in space.ties)]


def _chain(space: Space, point: FloatArray) -> FloatArray:
    """(paths and followers, d) d value / d u."""
    slopes = np.diag(space.slopes(point))
    places = {path: i for i, path in enumerate(space.paths)}
    followers = [tie.slope * slopes[places[tie.leader]] for tie in space.ties]
    return np.vstack([slopes, *followers])


def _chained(gradients: CurveGradients, chain: FloatArray, paths: tuple[str, ...]) -> CurveGradients:
    def chained(cases: Mapping[str, Mapping[str, FloatArray]]) -> dict[str, dict[str, FloatArray]]:
        return {case: {r: g @ chain for r, g in responses.items()} for case, responses in cases.items()}

    return replace(
        gradients,
        paths=paths,
        cases=chained(gradients.cases),
        static={r: g @ chain for r, g in gradients.static.items()},
        half_width=chained(gradients.half_width),
    )


def scaled_slopes(target: CurveTarget, curves: CurveGradients) -> FloatArray:
    """(2 n, d) slopes of one curve at the measured inputs, scaled as `Targets.scaled_curves`."""
    sides_slopes = curves.cases[target.load_case][target.response]
    sides = [interpolated(target.input, curves.inputs[target.load_case], side) for side in sides_slopes]
    return np.asarray(np.vstack(sides) / (target.objective.norm * np.sqrt(target.curve.size)))
