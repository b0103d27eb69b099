"""Surrogates of all outputs of an archive, the best design they predict, and what they say of a design."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.modelled.archive import Archive
from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.modelled.levels import on_levels
from doe_kc.correlation.modelled.maximizer import gauss_newton
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.correlation.problem import Problem, RatingForecast
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted
from doe_kc.surrogates.learning import Learning
from doe_kc.surrogates.models.gp import FirstOrderTrend, GaussianProcess
from doe_kc.surrogates.training import constant_outputs
from doe_kc.surrogates.varying import fit_varying
from doe_kc.variables import Space

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
