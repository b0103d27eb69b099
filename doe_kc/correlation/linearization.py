"""First-order expansion of everything a model answers, about a point of the space of variables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

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
    paths = moved_paths(space)
    exact = sensitivities(there, solution, paths)
    slopes = characteristic_gradients(there, solution, paths, windows=windows, exact=exact)
    curves = _chained(gradients_of(solution, exact), space, point, space.paths)
    return Linearization(to_places(slopes, space, space.slopes(point)), curves)


def value_gradients(
    there: Axle,
    solution: Solution,
    space: Space,
    directions: Mapping[str, Mapping[str, float]],
    input_gain: str,
    pool: Executor | None = None,
) -> CurveGradients:
    """Curves of the axle to first order: the values of d variables and of what follows them, for `to_places`,
    then `directions`, then the gain of each curve's own load case.

    solution: of that axle. directions, input_gain, pool: see `sensitivities`.
    """
    paths = moved_paths(space)
    exact = sensitivities(
        there, solution, paths, directions, outputs=CURVE_OUTPUTS, input_gain=input_gain, pool=pool
    )
    return gradients_of(solution, exact)


def moved_paths(space: Space) -> list[str]:
    """Paths of the variables, then those of what follows them."""
    return [*space.paths, *(tie.follower for tie in space.ties)]


def to_places(gradient: FloatArray, space: Space, slopes: FloatArray) -> FloatArray:
    """(..., d and others) derivatives to the places u, from those to the values of d paths, of their
    followers and of others, which stay what they are. slopes: (d,) dvalue/du.

    Column by column: products with the matrix of all dvalue/du, which is all but diagonal, took an eighth of
    the time of all derivatives.
    """
    count, end = space.dimension, space.dimension + len(space.ties)
    out = np.concatenate([gradient[..., :count], gradient[..., end:]], axis=-1)
    places = {path: i for i, path in enumerate(space.paths)}
    for i, tie in enumerate(space.ties, start=count):
        out[..., places[tie.leader]] += tie.slope * gradient[..., i]
    out[..., :count] *= slopes
    return out


def _chained(
    gradients: CurveGradients, space: Space, point: FloatArray, paths: tuple[str, ...]
) -> CurveGradients:
    slopes = space.slopes(point)

    def chained(responses: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        return {response: to_places(g, space, slopes) for response, g in responses.items()}

    return replace(
        gradients,
        paths=paths,
        cases={case: chained(responses) for case, responses in gradients.cases.items()},
        static=chained(gradients.static),
        half_width={case: chained(responses) for case, responses in gradients.half_width.items()},
    )


def scaled_slopes(target: CurveTarget, curves: CurveGradients) -> FloatArray:
    """(2 n, d) slopes of one curve at the measured inputs, scaled as `Targets.scaled_curves`."""
    sides_slopes = curves.cases[target.load_case][target.response]
    sides = [interpolated(target.input, curves.inputs[target.load_case], side) for side in sides_slopes]
    return np.asarray(np.vstack(sides) / (target.objective.norm * np.sqrt(target.curve.size)))
