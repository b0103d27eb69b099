"""Efficient global optimization of the rating as one number, by SMT: a peer through the methods' interface.

SMT's own EGO with its KPLS surrogate: expected improvement, SLSQP with finite differences from 20 starts.
It sees the rating alone, not the outputs that it is made of, and constraints only as their penalty. In 60 to
70 variables one proposal takes half a minute to one and a half on one core.
References: M. A. Bouhlel et al., Structural and Multidisciplinary Optimization 53(5), 2016; P. Saves et al.,
SMT 2.0, Advances in Engineering Software 188, 2024; D. R. Jones et al., J. Global Optim. 13, 1998.
"""

from __future__ import annotations

import contextlib
import io
import warnings
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np

from doe_kc.correlation.methods._base import MethodSettings
from doe_kc.correlation.methods._sampled import SurrogateMethod
from doe_kc.correlation.modelled.history import SearchHistory
from doe_kc.correlation.problem import Candidate, Problem, RatingForecast
from doe_kc.ground.errors import RunError
from doe_kc.ground.typing import FloatArray

SMT_DESIGNS = 3
"""Designs with an answer that the surrogate needs."""


@final
class SmtEgo(SurrogateMethod):
    """State: beside the answers why SMT gave up."""

    id: ClassVar[str] = "smt_ego"
    label: ClassVar[str] = "Scalar EGO of SMT (KPLS)"

    def __init__(self, problem: Problem, settings: MethodSettings) -> None:
        super().__init__(problem, settings)
        self._stopped = ""

    @property
    def stopped(self) -> str:
        """SMT could not train its surrogate, or found no expected improvement."""
        return self._stopped

    def _round(self, rng: np.random.Generator) -> list[Candidate]:
        """The designs of SMT's next iteration; failed ones are left out of its surrogate."""
        record = self._record
        if len(record.sound) < SMT_DESIGNS or np.ptp([e.merit for e in record.sound]) == 0.0:
            return self._random(record, rng)
        return self._iteration(record, rng)

    def _iteration(self, record: SearchHistory, rng: np.random.Generator) -> list[Candidate]:
        unique = {e.point.tobytes(): e for e in reversed(record.sound)}
        points = np.array([e.point for e in unique.values()])
        losses = np.array([-e.merit for e in unique.values()])
        try:
            found = propose(points, losses, number=self._settings.batch, seed=int(rng.integers(2**31)))
        except RunError as error:  # ends the search, not the run: what is found so far stays
            self._stopped = str(error)
            return []
        if not found:
            self._stopped = "SMT's search for the largest expected improvement found no design"
        out: list[Candidate] = []
        for proposal in found:
            new = record.fresh(proposal.point, [c.point for c in out], rng)
            out.append(Candidate(new, "expected improvement", self._prediction(proposal)))
        return out

    def _prediction(self, proposal: SmtProposal) -> RatingForecast:
        unknown = np.full(len(self._problem.targets.characteristics), np.nan)
        return RatingForecast(unknown, unknown, -proposal.loss, proposal.loss_sd)

    def _random(self, record: SearchHistory, rng: np.random.Generator) -> list[Candidate]:
        drawn = self._problem.space.drawn(rng.random((self._settings.batch, self._problem.space.dimension)))
        return [Candidate(record.fresh(p, [], rng), "random") for p in drawn]


@dataclass(frozen=True)
class SmtProposal:
    """point: (d,) in the unit cube. loss, loss_sd: what the surrogate expects there."""

    point: FloatArray
    loss: float
    loss_sd: float


def propose(points: FloatArray, losses: FloatArray, *, number: int, seed: int) -> list[SmtProposal]:
    """Next designs that EGO.optimize would run after `points` (n, d) with `losses` (n,) to be minimized.

    EGO as it is: KPLS and expected improvement with their defaults, also of several at once.
    One of its iterations is run on a function that only notes what it is asked for. Empty when its inner
    search fails. RunError when the surrogate cannot be trained.
    """
    from smt import applications, design_space, surrogate_models

    library: Any = applications
    models: Any = surrogate_models
    asked: list[FloatArray] = []

    def note(x: FloatArray) -> FloatArray:
        asked.extend(np.array(x, dtype=float))
        return np.zeros((len(x), 1))

    space = design_space.DesignSpace(np.tile([0.0, 1.0], (points.shape[1], 1)), seed=seed)
    surrogate = models.KPLS(design_space=space, print_global=False, seed=seed)
    ego = library.EGO(
        n_iter=1,
        criterion="EI",
        n_parallel=number,
        xdoe=points.copy(),
        ydoe=losses[:, None].copy(),
        surrogate=surrogate,
        seed=seed,
    )
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of SLSQP at the bounds
        try:
            ego.optimize(note)
        except (ValueError, np.linalg.LinAlgError) as error:
            raise RunError(f"SMT's EGO could not be trained on {len(points)} designs ({error}).") from None
    return [_expected(ego.gpr, np.clip(x, 0.0, 1.0)) for x in _without_repeats(asked, points)]


def _without_repeats(asked: list[FloatArray], points: FloatArray) -> list[FloatArray]:
    """After a failed inner search EGO asks for the last known designs again, before the new ones."""
    for repeated in range(min(len(asked), len(points)), 0, -1):
        if np.array_equal(np.array(asked[:repeated]), points[-repeated:]):
            return asked[repeated:]
    return asked


def _expected(surrogate: Any, point: FloatArray) -> SmtProposal:
    loss = float(surrogate.predict_values(point[None])[0, 0])
    variance = float(surrogate.predict_variances(point[None])[0, 0])
    return SmtProposal(point, loss, float(np.sqrt(max(variance, 0.0))))
