"""Chooses the designs of a round: where the surrogates of the objectives see the front, spread over it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from doe_kc.correlation.front import Objectives, bearable, non_dominated, only_constraints, weighted
from doe_kc.correlation.methods.pareto.nsga3 import Judge, nsga3, reference_directions
from doe_kc.correlation.modelled.archive import Archive, principal_axes
from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.modelled.proposal import best_predicted
from doe_kc.correlation.modelled.trust_region import TrustBox
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.targets import Targets


class ModelledObjectives:
    """Of the outputs of an archive: k characteristics, q curve scores."""

    def __init__(self, targets: Targets, objectives: Objectives, archive: Archive, model: Fitted) -> None:
        self._targets, self._found, self._model = targets, objectives, model
        scaled = np.array([e.scaled for e in archive.solved])
        self._mean, self._basis = principal_axes(scaled, targets)
        self._parts = [self._part(g) for g in range(len(objectives.names))]
        self._constraints = Composite(only_constraints(targets), np.zeros(0), np.zeros((0, 0)))

    def values(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Objectives (p, g) and relative violation (p,) at points (p, d)."""
        h = self._model.predict(points)
        k = len(self._targets.characteristics)
        values = [-part.rating(np.hstack([h[:, chosen], h[:, k:]])) for chosen, part in self._parts]
        return np.column_stack(values), -self._constraints.rating(h[:, :k])

    def weighted(self, weight: FloatArray) -> Composite:
        """The rating with the objectives weighted (g,), to search one corner of the front."""
        return Composite(weighted(self._targets, self._found, weight), self._mean, self._basis)

    def _part(self, place: int) -> tuple[np.ndarray, Composite]:
        """Places of the characteristics of one objective, and the rating of its terms alone."""
        chosen = np.flatnonzero(self._found.characteristics == place)
        lines = np.flatnonzero(self._found.curves == place)
        own = replace(
            self._targets,
            characteristics=tuple(replace(self._targets.characteristics[i], constraint=None) for i in chosen),
            curves=tuple(self._targets.curves[i] for i in lines),
            misfit=None,
        )
        keep = [np.arange(self._mean.size)[self._targets.blocks[i]] for i in lines]
        columns = np.concatenate([*keep, np.zeros(0, dtype=int)]).astype(int)
        return chosen, Composite(own, self._mean[columns], self._basis[:, columns])


GENERATIONS = 40
"""Of NSGA-III on the models, begun at the front that is known: it needs to follow, not to find it."""
STRESS = 4.0
"""Weight of the objective that a starting corner favours, the others 1."""
CORNER_SPREAD = 0.05
"""Standard deviation of the rest of the first population about the corners, share of the bounds."""


def predicted_front(
    record: SearchHistory, modelled: ModelledObjectives, box: TrustBox, count: int, rng: np.random.Generator
) -> FloatArray:
    """(p, d) non-dominated designs on levels that the surrogates expect, of `count` objectives."""
    judge = _judge(record, modelled)
    directions = reference_directions(count)
    first = _first_population(record, modelled, box, directions, rng)
    seed = int(rng.integers(2**31))
    population = nsga3(judge, first, directions, box.lower, box.upper, generations=GENERATIONS, seed=seed)
    points = np.unique(record.problem.space.snapped(population), axis=0)
    values, violation = judge(points)
    if (violation > 0.0).all():
        return np.asarray(points[non_dominated(np.column_stack([values, violation]))])
    allowed = np.flatnonzero(violation <= 0.0)
    return np.asarray(points[allowed[non_dominated(values[allowed])]])


def _judge(record: SearchHistory, modelled: ModelledObjectives) -> Judge:
    """Objectives on levels; a loss beyond what is bearable counts as a violation."""
    space = record.problem.space
    limit = bearable(modelled.values(record.best.point[None])[0].sum())

    def judge(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        values, violation = modelled.values(space.snapped(x))
        return values, violation + np.maximum(values.sum(axis=1) - limit, 0.0) / max(abs(limit), 1e-12)

    return judge


def _first_population(
    record: SearchHistory,
    modelled: ModelledObjectives,
    box: TrustBox,
    directions: FloatArray,
    rng: np.random.Generator,
) -> FloatArray:
    """(r, d) corners, then confirmed designs in the box, then random ones near both.

    From random designs alone NSGA-III would need far more generations.
    """
    inside = [e.point for e in record.ranked if np.all((e.point >= box.lower) & (e.point <= box.upper))]
    seeds = [*corners(record, modelled, box, directions.shape[1]), *inside][: len(directions)]
    chosen = rng.integers(len(seeds), size=len(directions) - len(seeds))
    near = np.array(seeds)[chosen] + CORNER_SPREAD * rng.standard_normal((len(chosen), box.lower.size))
    return box.clip(np.vstack([np.array(seeds), near]))


def corners(
    record: SearchHistory, modelled: ModelledObjectives, box: TrustBox, count: int
) -> list[FloatArray]:
    """Best predicted rating with equal weights, and with each objective stressed in turn."""
    weights = [np.ones(count), *(1.0 + (STRESS - 1.0) * np.eye(count))]
    composites = [modelled.weighted(w) for w in weights]
    start = record.best.point
    return [best_predicted(record.problem, record.model, c, box, start, doubt=0.0) for c in composites]


def spread_out(values: FloatArray, known: FloatArray, number: int) -> NDArray[np.int_]:
    """Places of up to `number` rows (p, g), each the farthest from `known` (n, g) and those chosen before.

    Distances in objectives scaled by the range of the rows.
    """
    scale = np.ptp(values, axis=0)
    scale = np.where(scale > 0.0, scale, 1.0)
    taken = [*(known / scale)]
    chosen: list[int] = []
    while len(chosen) < min(number, len(values)):
        apart = np.linalg.norm((values / scale)[:, None] - np.array(taken)[None], axis=2).min(axis=1)
        chosen.append(int(np.argmax(apart)))
        taken.append(values[chosen[-1]] / scale)
    return np.array(chosen, dtype=int)
