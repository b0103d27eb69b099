"""Objectives and constraint violation of designs that were not run, from surrogates of the outputs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from doe_kc.correlation.modelled.archive import Archive, principal_axes
from doe_kc.correlation.modelled.composite import Composite
from doe_kc.correlation.objectives import Objectives, only_constraints, weighted
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogates.interface import Fitted
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
