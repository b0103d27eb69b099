"""From a continuous optimum to a design on the variables' levels.

Rounding moves every variable by up to half a level at once: more than the last percent of a correlation
allows, and into directions that the surrogates know little of. Better are few moves of one or two variables
that cancel each other's errors, from the best design so far and from the rounded optimum alike: a
closest-vector problem solved by descent on the linearized outputs, every design on the way judged by its
expected rating.
"""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.least_squares import with_prior
from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.prior import Prior
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted

MOVES = 60
FLAT = 1e-9
"""Curvature added to every variable, so that a move without effect is not made."""
SIGNS = np.array([1.0, -1.0])


def on_levels(
    model: Fitted,
    composite: Composite,
    point: FloatArray,
    steps: FloatArray,
    starts: FloatArray,
    prior: Prior,
    *,
    doubt: float = 1.0,
) -> FloatArray:
    """(d,) the best design found on the levels near `point`, the continuous optimum.

    steps: (d,) distance of levels, 0 for a continuous variable, which stays. starts: (s, d) designs on
    the levels to descend from beside the rounded point. prior, doubt: as in `gauss_newton`.
    """
    movable = np.flatnonzero(steps > 0)
    if not movable.size:
        return point
    rounded = point.copy()
    rounded[movable] = np.round(point[movable] / steps[movable]) * steps[movable]
    designs = [rounded]
    for start in (rounded, *starts):
        first = start.copy()
        first[steps == 0] = point[steps == 0]
        designs.extend(_path(model, composite, first, steps, movable, prior, doubt))
    points = np.clip(np.array(designs), 0.0, 1.0)
    expected = composite.expected(model.predict(points), doubt * model.variance(points))
    return np.asarray(points[int(np.argmax(expected - prior.cost(points)))])


def _path(
    model: Fitted,
    composite: Composite,
    start: FloatArray,
    steps: FloatArray,
    movable: np.ndarray,
    prior: Prior,
    doubt: float,
) -> list[FloatArray]:
    """Designs that a descent from `start` passes, majorized anew once it has stopped."""
    out: list[FloatArray] = []
    current = np.clip(start, 0.0, 1.0)
    for _ in range(3):
        known = model.predict_all(current[None])
        near = composite.majorizer(known.mean[0], doubt * known.variance[0])
        slope = known.gradient[0][:, movable] * steps[movable]
        places = current[movable] / steps[movable]
        weight = prior.weight[movable] * steps[movable] ** 2
        hessian, gradient = with_prior(
            slope.T @ near.hessian @ slope,
            slope.T @ near.gradient,
            weight,
            places - prior.centre[movable] / steps[movable],
            flat=FLAT,
        )
        moves = descend(hessian, gradient, -places, 1.0 / steps[movable] - places)
        for move in moves:
            design = current.copy()
            design[movable] += move * steps[movable]
            out.append(design)
        if not moves:
            break
        current = out[-1]
    return out


def descend(
    hessian: FloatArray, gradient: FloatArray, lower: FloatArray, upper: FloatArray
) -> list[FloatArray]:
    """Whole-numbered moves (d,), each lower in 1/2 s'Hs + g's, by the best step of one or two variables."""
    moved, slope = np.zeros(gradient.size), gradient.astype(float)
    half, out = 0.5 * np.diag(hessian), []
    for _ in range(MOVES):
        single = SIGNS[:, None] * slope + half
        allowed = np.array([moved + 1.0 <= upper + 1e-9, moved - 1.0 >= lower - 1e-9])
        single = np.where(allowed, single, np.inf)
        steps = _best(single, hessian)
        if not steps:
            break
        for place, sign in steps:
            moved[place] += sign
            slope = slope + hessian[:, place] * sign
        out.append(moved.copy())
    return out


def _best(single: FloatArray, hessian: FloatArray) -> list[tuple[int, float]]:
    """The one or two unit steps that lower the quadratic most; none when no step does."""
    pairs = single[:, None, :, None] + single[None, :, None, :]
    pairs = pairs + SIGNS[:, None, None, None] * SIGNS[None, :, None, None] * hessian
    np.einsum("abii->abi", pairs)[:] = np.inf
    one = np.unravel_index(np.argmin(single), single.shape)
    two = np.unravel_index(np.argmin(pairs), pairs.shape)
    if min(single[one], pairs[two]) >= -1e-10:
        return []
    if single[one] <= pairs[two]:
        return [(int(one[1]), float(SIGNS[one[0]]))]
    return [(int(two[2]), float(SIGNS[two[0]])), (int(two[3]), float(SIGNS[two[1]]))]
