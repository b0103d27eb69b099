"""Load cases held out: predicted by a model that was fitted to all the others."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.gauss_newton import chord_fit, fit, known_columns
from doe_kc.discovery.thresholds import CHORD_DECREASE, NOISE_SD_SHARE, REFIT_STEPS


@dataclass(frozen=True)
class HeldOutScore:
    """How well a load case held out is predicted."""

    rms: float
    """RMS of the records' deviations in standard deviations of the prediction, that of its parameters among
    them; 1 is as good as predicted."""
    score: float
    """ln of the predictive density, relative to constants that all models share."""
    size: int
    """Number of records."""

    @property
    def excess(self) -> float:
        """Standard deviations by which the RMS is above 1, of so many records and of the noise's size."""
        return (self.rms - 1.0) / float(np.hypot(1.0 / np.sqrt(2.0 * self.size), NOISE_SD_SHARE))


@dataclass(frozen=True)
class HeldOut:
    """One load case, predicted by models that were fitted to all the others."""

    load_case: str
    """Its id."""
    tuned: HeldOutScore
    """By the re-tuned model without an effect."""
    with_effect: HeldOutScore
    """By the re-tuned model with the effects."""
    law_granted: HeldOutScore
    """By that, the discrepancy of its effects' laws among the errors of the records."""

    @property
    def gain(self) -> float:
        """ln predictive density won by the effects."""
        return self.with_effect.score - self.tuned.score


def held_out_scores(with_effects: Fit, with_discrepancy: Fit, case: str) -> tuple[HeldOutScore, HeldOutScore]:
    """`with_effect` and `law_granted` of a load case, see `HeldOut`.

    with_effects: fitted to the records' own errors; with_discrepancy: to errors that hold that of the laws.
    """
    with_effect = score_without(with_effects, case)
    if with_discrepancy.model.likelihood is with_effects.model.likelihood:
        return with_effect, with_effect
    model = replace(with_discrepancy.model, left_out=case)
    return with_effect, held_out_score(with_discrepancy, chord_fit(with_discrepancy, model))


def score_without(fit: Fit, case: str) -> HeldOutScore:
    """Of a load case of the records, predicted from all the others."""
    return held_out_score(fit, fit_without(fit, case))


def fit_without(start: Fit, case: str) -> Fit:
    """The model fitted to the other load cases, from where it is; on new derivatives where it goes far.

    What is far is counted in what remains of the records: a model that is off by five standard deviations
    is not told apart by one.
    """
    model = replace(start.model, left_out=case)
    near = chord_fit(start, model)
    gained = cost_of(model, start.z, start.residual) - near.cost
    if near.converged and gained <= CHORD_DECREASE * max(1.0, start.rms**2):
        return near
    return fit(model, near.z, steps=REFIT_STEPS, known=known_columns(near, model), aged=gained)


def held_out_score(all_records: Fit, others: Fit) -> HeldOutScore:
    """The score of the records of a load case by the fits to all records and to the others.

    Their predictive density is the evidence of all records over that of the others, each by Laplace's
    approximation at its own point (L. Tierney, J. B. Kadane, Journal of the American Statistical Association
    81, 1986): r'C^-1 r is what the cost falls when the load case is left out, det C the quotient of the
    Hessians' determinants. For a linear model that is the Gaussian prediction; it holds as well where the fit
    to the others goes far along what they do not see, where derivatives taken there do not.
    """
    size = int(np.count_nonzero(~others.model.used))
    square = max(0.0, all_records.cost - others.cost)
    score = -0.5 * square - 0.5 * (_log_determinant(all_records) - _log_determinant(others))
    return HeldOutScore(float(np.sqrt(square / size)), score, size)


def _log_determinant(fit: Fit) -> float:
    return float(np.linalg.slogdet(fit.hessian)[1])
