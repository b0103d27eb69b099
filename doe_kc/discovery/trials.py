"""The joint refits of the leading hypotheses, and which of them leads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.discovery.belief import believed
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screen import Screened
from doe_kc.discovery.thresholds import TIED
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis, Size


@dataclass(frozen=True)
class HypothesisFit:
    """A hypothesis refitted jointly. gain: ln of the evidence over the model without it, times its odds."""

    hypothesis: Hypothesis
    fit: Fit
    gain: float


def tried(current: Fit, screened: Sequence[Screened], bench: DiscoveryWorkers) -> list[HypothesisFit]:
    """The joint refits from the screened sizes, best first; those without a solution are left out."""
    starts = [
        (current.model.extended(s.hypothesis), np.concatenate([current.z, s.amplitudes])) for s in screened
    ]
    fits = bench.fitted(starts, "refitting leaders", current.jacobian)
    trials = []
    for s, found in zip(screened, fits, strict=True):
        if found is not None:
            gain = found.evidence - current.evidence + log_odds(s.hypothesis)
            trials.append(HypothesisFit(s.hypothesis, found, gain))
    return sorted(trials, key=lambda t: -t.gain)


def log_odds(hypothesis: Hypothesis) -> float:
    """ln of how much likelier its effect is than others before any measurement."""
    return float(np.log(EFFECTS[hypothesis.effect].odds))


def plausible(trial: HypothesisFit) -> bool:
    """Whether the effect's sizes are believed."""
    return believed(amounts(trial))


def amounts(trial: HypothesisFit) -> list[tuple[Size, float, float]]:
    """Sizes of the trial's effect that say how much, in typical ones, with their standard deviations."""
    sizes = trial.hypothesis.sizes
    sd = np.sqrt(np.diag(trial.fit.covariance))
    known = [(s, float(trial.fit.z[i]), float(sd[i])) for i, s in enumerate(sizes, start=-len(sizes))]
    return [item for item in known if not item[0].shape]


def stiffer_first(trials: list[HypothesisFit]) -> list[HypothesisFit]:
    """Of one signed effect at two places that say the same, the one of positive size leads, by convention.

    A bushing that is stiffer on the left is, with both re-tuned, one that is softer on the right.
    """
    if len(trials) < 2:
        return trials
    first, second, *rest = trials
    same = first.hypothesis.effect == second.hypothesis.effect and first.gain - second.gain < TIED
    one = len(first.hypothesis.sizes) == len(second.hypothesis.sizes) == 1
    if same and one and first.fit.z[-1] < 0.0 < second.fit.z[-1]:
        return [second, first, *rest]
    return trials
