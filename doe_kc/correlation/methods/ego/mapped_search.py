"""Proposals from the twin of an outside model: the best design of the twin, its answers mapped onto those of
the outside model (`manifold_mapping.py`), within a trust region.

The twin is solved and expanded anew as a proposal is made, so that it is an optimum of the nonlinear model.
benchmarks/twin.py compares this with other corrections.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from doe_kc.correlation.methods.ego.strategy import GAIN
from doe_kc.correlation.modelled.archive import Archive, build_archive
from doe_kc.correlation.modelled.linear_model import LinearModel
from doe_kc.correlation.modelled.manifold_mapping import ManifoldMapping
from doe_kc.correlation.modelled.proposal import gauss_newton, levelled
from doe_kc.correlation.modelled.trust_region import RadiusRule, TrustRegion
from doe_kc.correlation.problem import Candidate, Evaluated, Problem, RatingForecast
from doe_kc.correlation.twin_changes import USEFUL_SHARE, explained_share
from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray

MAPPED = "mapped twin"
"""Origin of its proposals."""
MAPPED_RADIUS = RadiusRule(first=0.5, smallest=0.01, largest=0.5, shrinkage=0.5, growth=2.0, floor="stay")
MAPPED_PATIENCE = 2
"""Proposals in a row without a worthwhile gain after which other searches go on."""
EXPANSIONS = 5
"""Of the twin in one proposal, some 0.2 s each; most settle after three."""
INNER_SHARES = (1.0, 0.5, 0.25, 0.1)
"""Of an inner step, tried in turn."""
INNER_GAIN = 1e-4
"""Relative gain of an inner step below which a proposal has settled."""


ModelBuilder = Callable[[Problem, Sequence[Evaluated]], "MappedModel | None"]


@dataclass(frozen=True)
class MappedSearch:
    """region: about the best design. idle: proposals in a row without a worthwhile gain. useful: whether the
    twin's changes are those of the outside model. models: how the twin is corrected."""

    problem: Problem
    region: TrustRegion = field(default_factory=lambda: TrustRegion.first(MAPPED_RADIUS))
    idle: int = 0
    useful: bool = True
    models: ModelBuilder = field(default_factory=lambda: mapped_model)

    @property
    def active(self) -> bool:
        """Whether it still proposes."""
        return self.useful and self.idle < MAPPED_PATIENCE

    def after(self, evaluated: Sequence[Evaluated], answer: Evaluated) -> MappedSearch:
        """With the answer to its proposal. evaluated: all designs before it."""
        best = max(evaluated, key=lambda e: e.merit)
        gain = answer.merit - best.merit
        idle = 0 if gain > GAIN * max(abs(best.merit), 1e-3) else self.idle + 1
        moved = replace(
            self,
            region=self.region.after(
                float(gain > 0.0), length=float(np.abs(answer.point - best.point).max())
            ),
            idle=idle,
        )
        return moved if idle < MAPPED_PATIENCE else moved.settled([*evaluated, answer])

    def settled(self, evaluated: Sequence[Evaluated]) -> MappedSearch:
        """With nothing more to propose: judged by the changes of both models over all designs."""
        share = explained_share(self.problem, evaluated)
        return replace(self, idle=MAPPED_PATIENCE, useful=share is None or share >= USEFUL_SHARE)

    def candidate(self, evaluated: Sequence[Evaluated]) -> Candidate | None:
        """The next proposal; None where the twin leads to a known design or has no equilibrium."""
        solved = [e for e in evaluated if e.score is not None]
        try:
            model = self.models(self.problem, solved)
            proposal = None if model is None else _proposal(model, self.region)
        except RunError:
            return None
        if proposal is None or any(np.array_equal(proposal.point, e.point) for e in evaluated):
            return None
        return proposal


@dataclass(frozen=True)
class MappedModel:
    """The twin with its answers mapped onto those of the outside model."""

    problem: Problem
    archive: Archive
    mapping: ManifoldMapping

    def outputs(self, point: FloatArray) -> FloatArray | None:
        """(k + q,) expected of the outside model at a point (d,); None where the twin has no equilibrium."""
        answer = self.problem.twin_answer(point)
        return None if answer.score is None else self.mapping.at(self.archive.outputs_of(answer))

    def merit(self, point: FloatArray) -> float:
        """Rating less the prior's cost, -inf without an equilibrium."""
        outputs = self.outputs(point)
        if outputs is None:
            return -np.inf
        return float(self.archive.composite.rating(outputs[None])[0] - self.problem.prior.cost(point))

    def expanded(self, point: FloatArray) -> LinearModel:
        """First-order expansion at a point (d,); RunError where the twin has no equilibrium."""
        slopes = self.archive.slopes_of(self.problem.output_slopes(point))
        outputs = self.outputs(point)
        if outputs is None:
            raise RunError("the twin has no equilibrium")
        return LinearModel.expansion(point, outputs, self.mapping.matrix @ slopes)


def mapped_model(problem: Problem, solved: Sequence[Evaluated]) -> MappedModel | None:
    """From the designs that both models answer; None where the best one is not among them."""
    best = max(solved, key=lambda e: e.merit)
    if problem.twin_answer(best.point).score is None:
        return None
    archive = build_archive(problem.search, solved, problem.output_slopes(best.point))
    answers = [problem.twin_answer(e.point) for e in archive.solved]
    both = [i for i, answer in enumerate(answers) if answer.score is not None]
    scale = np.ones(archive.outputs.shape[1])
    characteristics = problem.search.characteristics
    scale[: len(characteristics)] = [t.scale for t in characteristics]
    mapping = ManifoldMapping.of(
        archive.outputs[both],
        np.array([archive.outputs_of(answers[i]) for i in both]),
        next(place for place, i in enumerate(both) if archive.solved[i] is archive.best),
        scale,
    )
    return MappedModel(problem, archive, mapping)


def _proposal(model: MappedModel, region: TrustRegion) -> Candidate:
    """The design on levels of the best merit expected in the region, and what is expected of it."""
    problem, composite, start = model.problem, model.archive.composite, model.archive.best.point
    box, point = region.box(start), start
    near, merit = model.expanded(point), model.merit(point)
    for _ in range(EXPANSIONS):
        step = gauss_newton(near, composite, box, point, problem.prior, doubt=0.0) - point
        better = next(
            (
                (trial, value)
                for trial in (point + share * step for share in INNER_SHARES)
                if (value := model.merit(trial)) > merit + INNER_GAIN * abs(merit)
            ),
            None,
        )
        if better is None:
            break
        point, merit = better
        near = model.expanded(point)
    point = levelled(problem, near, composite, point, start, doubt=0.0)
    expected = near.predict(point[None])[0]
    k = len(problem.targets.characteristics)
    rating = float(composite.rating(expected[None])[0])
    return Candidate(point, MAPPED, RatingForecast(expected[:k], np.full(k, np.nan), rating, np.nan))
