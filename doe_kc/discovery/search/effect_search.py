"""What a search for the most probable set of effects ends with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.decision import Decision, Step
from doe_kc.discovery.search.law_discrepancy import marginal
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.search.set_prior import SetPrior


@dataclass(frozen=True)
class EffectSearch:
    """The search for the most probable set of effects, and the fits that it ends with."""

    tuned: Fit
    """The re-tuned axle without any effect, nor traces of them: the baseline of every comparison."""
    steps: tuple[Step, ...]
    """In their order; the last one accepts nothing, or reached the largest number of effects or of steps."""
    first: Decision
    """The first step, or after an exchange of effects the first one since: where it began without any effect,
    all that the verdict on a single effect takes; without derivatives where any later set was another."""
    screened: tuple[Screened, ...]
    """Every hypothesis as it was screened last, in the errors of `with_law_discrepancy`."""
    with_law_discrepancy: Fit
    """With all accepted effects; the errors of the records hold the discrepancy of the effects' laws."""
    with_effects: Fit
    """With the same effects, fitted to the records' own errors alone, from there: what is handed over."""
    discrepancy_shares: Mapping[str, float]
    """Member's name -> standard deviation of its law's discrepancy, relative to what it makes of a curve."""
    without_own_discrepancy: Mapping[str, Likelihood]
    """Name of a member with such a discrepancy -> the last errors of the records without its own."""
    prior: SetPrior
    """Probabilities of sets before the records."""
    shape_loss: float
    """ln evidence that frictions of free shape cost at the last, the width of their prior; 0 without any, and
    where one has more than the closed law."""
    with_other_laws: Fit | None
    """`with_law_discrepancy` by closed laws of its frictions where those have free shapes, or by free shapes
    where those fit as well but leave what closed laws explain; None where there is none."""
    optima: tuple[Fit, ...]
    """`with_law_discrepancy` at other optima of its frictions of free shape, where they fit as well; see
    `at_best_free_shape`."""
    larger: tuple[HypothesisFit, ...] = ()
    """Sets with one effect more, which one of its members may hide, up to 20 to 1 less probable than the last
    one, or more so by less than an effect needs; of a friction's own law of more numbers than the default
    one, those that fit as well, whatever their probability. To the records' own errors, without derivatives;
    see `with_series_compliances`."""

    @property
    def evidence(self) -> float:
        """ln evidence of the last set by the closed laws of most evidence, to the records' own errors."""
        return self.with_effects.evidence + self.shape_loss

    @property
    def log_posterior(self) -> float:
        """ln of the last set's probability, relative to a constant that all sets and errors share."""
        last = self.with_law_discrepancy
        return marginal(last) + self.shape_loss + self.prior.log(last.model.members)
