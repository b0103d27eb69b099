"""Ways to correct a twin by the answers of the outside model, as searches led by each of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from doe_kc.correlation.least_squares import most_probable_step
from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.methods.ego import Ego
from doe_kc.correlation.methods.ego.mapped_search import (
    MAPPED_PATIENCE,
    MappedModel,
    MappedSearch,
    mapped_model,
)
from doe_kc.correlation.modelled.linear_model import LinearModel
from doe_kc.correlation.problem import Evaluated, Problem
from doe_kc.correlation.twin import Twin
from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.interface import Fitted
from doe_kc.surrogate_models.models.gp import GaussianProcess
from doe_kc.surrogate_models.varying import fit_varying
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import Space

FEWEST = 3
"""Designs from which a Gaussian process is fitted; with fewer the difference is taken for constant."""
EXTRACTIONS = 3
"""Gauss-Newton steps of a parameter extraction."""


def constant(problem: Problem, solved: Sequence[Evaluated]) -> MappedModel | None:
    """The difference at the best design, everywhere."""
    model = mapped_model(problem, solved)
    if model is None:
        return None
    size = model.mapping.value.size
    return replace(model, mapping=replace(model.mapping, matrix=np.eye(size)))


@dataclass(frozen=True)
class DiscrepancyModel(MappedModel):
    """The twin and a Gaussian process of the differences."""

    discrepancy: Fitted

    def outputs(self, point: FloatArray) -> FloatArray | None:
        answer = self.problem.twin_answer(point)
        if answer.score is None:
            return None
        return np.asarray(self.archive.outputs_of(answer) + self.discrepancy.predict(point[None])[0])

    def expanded(self, point: FloatArray) -> LinearModel:
        slopes = self.archive.slopes_of(self.problem.output_slopes(point))
        outputs = self.outputs(point)
        if outputs is None:
            raise RunError("the twin has no equilibrium")
        return LinearModel.expansion(point, outputs, slopes + self.discrepancy.gradient(point[None])[0])


def discrepancy(problem: Problem, solved: Sequence[Evaluated]) -> MappedModel | None:
    """A Gaussian process of the differences of all outputs."""
    model = constant(problem, solved)
    if model is None or len(model.archive.solved) < FEWEST:
        return model
    answers = [problem.twin_answer(e.point) for e in model.archive.solved]
    if any(a.score is None for a in answers):
        return model
    apart = model.archive.outputs - np.array([model.archive.outputs_of(a) for a in answers])
    fitted = fit_varying(GaussianProcess(), model.archive.points, apart)
    return DiscrepancyModel(model.problem, model.archive, model.mapping, fitted)


@dataclass(frozen=True)
class ShiftedTwin(Twin):
    """The twin at other parameters than it is asked for: by `shift` (d,) places of the space."""

    shift: FloatArray = field(default_factory=lambda: np.zeros(0))

    def answer(self, space: Space, point: FloatArray) -> Outcome:
        return super().answer(space, np.clip(point + self.shift, 0.0, 1.0))

    def linearize(self, space: Space, point: FloatArray) -> Linearization:
        return super().linearize(space, np.clip(point + self.shift, 0.0, 1.0))


def space_mapped(problem: Problem, solved: Sequence[Evaluated]) -> MappedModel | None:
    """Parameter extraction: the twin's parameters moved until it answers as the outside model at the best
    design, as far as their prior allows; what is left is taken for constant."""
    best = max(solved, key=lambda e: e.merit)
    twin, data, space = problem.twin, problem.likelihood, problem.space
    if twin is None:
        return None
    shift = np.zeros(space.dimension)
    for _ in range(EXTRACTIONS):
        moved = ShiftedTwin(twin.axle, twin.windows, shift)
        answer = moved.answer(space, best.point)
        expansion = moved.linearize(space, best.point)
        apart = data.residual(answer.curves, answer.characteristics) - data.residual(
            best.outcome.curves, best.outcome.characteristics
        )
        jacobian = data.jacobian(expansion.curves, expansion.characteristics)
        step = most_probable_step(jacobian, apart, space.start + shift, space)
        shift = np.clip(best.point + shift + step, 0.0, 1.0) - best.point
    return constant(replace(problem, twin=ShiftedTwin(twin.axle, twin.windows, shift)), solved)


Correction = Callable[[Problem, Sequence[Evaluated]], MappedModel | None]
AS_SHIPPED = "manifold mapping"
CORRECTIONS: Mapping[str, Correction | None] = {
    AS_SHIPPED: mapped_model,
    "constant difference": constant,
    "Gaussian process of the differences": discrepancy,
    "space mapping": space_mapped,
    "slopes at the best design only": None,
}
"""None: the twin gives slopes alone."""


def led_by(method: Ego, problem: Problem, correction: Correction | None) -> Ego:
    """The method with another correction of the twin; None: the twin gives slopes alone."""
    search = MappedSearch(problem, idle=MAPPED_PATIENCE)
    method._mapped = search if correction is None else MappedSearch(problem, models=correction)
    return method
