"""From surrogates of all outputs to the best design they predict: Gauss-Newton in a box, then on levels.

Rounding moves every variable by up to half a level at once: more than the last percent of a correlation
allows, and into directions that the surrogates know little of. Better are few moves of one or two variables
that cancel each other's errors, from the best design so far and from the rounded optimum alike: a
closest-vector problem solved by descent on the linearized outputs, every design on the way judged by its
expected rating.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from doe_kc.correlation.least_squares import Prior, bounded_step, with_prior
from doe_kc.correlation.modelled.archive import Archive
from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.correlation.problem import Problem, RatingForecast
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.surrogate_models.learning import Learning
from doe_kc.surrogate_models.models.gp import FirstOrderTrend, GaussianProcess
from doe_kc.surrogate_models.training import constant_outputs
from doe_kc.surrogate_models.varying import fit_varying
from doe_kc.variables import Space

PROPOSAL_STEPS = 30
STEP_GAIN = 1e-4
"""Relative gain of a step below which the search has settled."""
ROUGH = 10
"""Iterations of each step's bounds: the next step goes on where they end."""


def gauss_newton(
    model: Fitted, composite: Composite, box: TrustBox, first: FloatArray, prior: Prior, *, doubt: float = 1.0
) -> FloatArray:
    """(d,) maximizer of the expected rating by majorized Gauss-Newton steps from `first`.

    doubt: factor of the predicted variances; 0 = the predictions are taken for true.
    """
    point = box.clip(first)

    def merit(x: FloatArray) -> float:
        variance = doubt * model.variance(x[None])[0] if doubt else np.zeros(model.outputs)
        expected = composite.expected(model.predict(x[None]), variance)
        return float(expected[0] - prior.cost(x))

    value = merit(point)
    for _ in range(PROPOSAL_STEPS):
        known = model.predict_all(point[None])
        near = composite.majorizer(known.mean[0], doubt * known.variance[0])
        jacobian = known.gradient[0]
        gradient = jacobian.T @ near.gradient + doubt * known.variance_gradient[0].T @ near.variance
        hessian, gradient = with_prior(
            jacobian.T @ near.hessian @ jacobian, gradient, prior.weight, point - prior.centre
        )
        step = bounded_step(hessian, gradient, box.lower - point, box.upper - point, iterations=ROUGH)
        point, gained = _line_search(merit, point, step, value)
        if gained <= STEP_GAIN * max(1.0, abs(value)):
            break
        value += gained
    return point


def _line_search(
    merit: Callable[[FloatArray], float], point: FloatArray, step: FloatArray, value: float
) -> tuple[FloatArray, float]:
    """The first share of the step that gains, and its gain; no step and 0 when none does."""
    for share in (1.0, 0.5, 0.25, 0.1, 0.02):
        trial_value = merit(point + share * step)
        if trial_value > value:
            return point + share * step, trial_value - value
    return point, 0.0


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


RATING_SAMPLES = 64
"""Draws for the standard deviation of a predicted rating."""
LEARNING = Learning()


def fit_outputs(archive: Archive, *, seed: int = 0, learning: Learning = LEARNING) -> Fitted:
    """Gaussian processes of all outputs, about the exact expansion where the archive has one.

    InputError when no output varies.
    """
    trend = None
    if archive.expansion is not None:
        at = int(np.flatnonzero((archive.points == archive.best.point).all(axis=1))[0])
        varies = ~constant_outputs(archive.outputs)
        trend = FirstOrderTrend(archive.best.point, archive.outputs[at][varies], archive.expansion[varies])
    model = GaussianProcess(trend=trend, learning=learning)
    return fit_varying(model, archive.points, archive.outputs, seed=seed)


def best_predicted(
    problem: Problem,
    model: Fitted,
    composite: Composite,
    box: TrustBox,
    first: FloatArray,
    *,
    start: FloatArray | None = None,
    doubt: float = 1.0,
) -> FloatArray:
    """(d,) design on levels of the best expected rating in the box, searched from `first`.

    start: (d,) design that the descent on the levels starts from too, by default `first`. doubt: factor of
    the predicted variances; 0 = the predictions are taken for true.
    """
    point = gauss_newton(model, composite, box, first, problem.prior, doubt=doubt)
    return levelled(problem, model, composite, point, first if start is None else start, doubt=doubt)


def levelled(
    problem: Problem,
    model: Fitted,
    composite: Composite,
    point: FloatArray,
    start: FloatArray,
    *,
    doubt: float,
) -> FloatArray:
    """(d,) design on levels near a continuous optimum (d,); start, doubt: as in `best_predicted`."""
    space = problem.space
    starts = space.snapped(start)[None]
    nearest = on_levels(model, composite, point, level_steps(space), starts, problem.prior, doubt=doubt)
    return space.snapped(nearest)


def forecast(
    problem: Problem, archive: Archive, model: Fitted, point: FloatArray, *, doubt: float = 1.0
) -> RatingForecast:
    """What a model of the archive's outputs expects at a point (d,); doubt: factor of its variances."""
    mean, variance = model.predict(point[None]), doubt * model.variance(point[None])[0]
    sd, k = np.sqrt(variance), len(problem.targets.characteristics)
    draws = np.random.default_rng(0).standard_normal((RATING_SAMPLES, sd.size))
    ratings = archive.composite.rating(mean + sd * draws)
    expected = float(archive.composite.expected(mean, variance)[0])
    return RatingForecast(mean[0, :k], sd[:k], expected, float(ratings.std()))


def level_steps(space: Space) -> FloatArray:
    """(d,) distance of levels, 0 for a continuous variable."""
    return np.array([0.0 if v.levels is None else 1.0 / (v.levels - 1) for v in space.variables])
