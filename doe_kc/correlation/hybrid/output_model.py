"""Surrogates of all outputs of an archive, the best design they predict, and what they say of a design."""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.composite import Composite
from doe_kc.correlation.ego.archive import Archive
from doe_kc.correlation.ego.levels import on_levels
from doe_kc.correlation.ego.proposal import TrustBox, gauss_newton
from doe_kc.correlation.problem import Problem, RatingForecast
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted
from doe_kc.surrogates.learning import Learning
from doe_kc.surrogates.models.gp import GaussianProcess
from doe_kc.surrogates.varying import fit_varying
from doe_kc.variables import Space

RATING_SAMPLES = 64
"""Draws for the standard deviation of a predicted rating."""
NUGGET = 1e-5
"""Share of each output's variance: what jumps and the left-out curve components disturb."""


def fit_outputs(archive: Archive, *, seed: int) -> Fitted:
    """Gaussian processes of all outputs; InputError when none of them varies."""
    model = GaussianProcess(learning=Learning(nugget=NUGGET))
    return fit_varying(model, archive.points, archive.outputs, seed=seed)


def best_predicted(
    problem: Problem,
    model: Fitted,
    composite: Composite,
    box: TrustBox,
    first: FloatArray,
    *,
    doubt: float = 1.0,
) -> FloatArray:
    """(d,) design on levels of the best expected rating in the box, searched from `first`."""
    space = problem.space
    point = gauss_newton(model, composite, box, first, problem.prior, doubt=doubt)
    starts = space.snapped(first)[None]
    levelled = on_levels(model, composite, point, level_steps(space), starts, problem.prior, doubt=doubt)
    return space.snapped(levelled)


def prediction(problem: Problem, archive: Archive, model: Fitted, point: FloatArray) -> RatingForecast:
    """What a model of the archive's outputs expects at a point (d,)."""
    mean, variance = model.predict(point[None]), model.variance(point[None])[0]
    sd, k = np.sqrt(variance), len(problem.targets.characteristics)
    draws = np.random.default_rng(0).standard_normal((RATING_SAMPLES, sd.size))
    ratings = archive.composite.rating(mean + sd * draws)
    expected = float(archive.composite.expected(mean, variance)[0])
    return RatingForecast(mean[0, :k], sd[:k], expected, float(ratings.std()))


def level_steps(space: Space) -> FloatArray:
    """(d,) distance of levels, 0 for a continuous variable."""
    return np.array([0.0 if v.levels is None else 1.0 / (v.levels - 1) for v in space.variables])
