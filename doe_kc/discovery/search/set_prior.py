"""The prior of a set of effects: one for accepting, taking out and reporting.

Each effect is in the car with a probability pi that is not known, pi ~ Beta(1, EFFECTS_ABSENT): with more
candidates each needs more evidence, which takes the place of a correction for multiplicity (J. G. Scott,
J. O. Berger, Annals of Statistics 38, 2010). The share of an effect is divided between its places.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import betaln

from doe_kc.discovery.thresholds import EFFECTS_ABSENT
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis


@dataclass(frozen=True)
class SetPrior:
    """Probabilities of sets before the records."""

    places: Mapping[str, int]
    """Effect -> the number of places in which it is looked for."""

    @staticmethod
    def of(library: Sequence[Hypothesis]) -> SetPrior:
        """The prior over the sets of a library."""
        return SetPrior(Counter(h.effect for h in library))

    def log(self, members: Sequence[Hypothesis]) -> float:
        """ln of the probability of a set, relative to a constant that all sets share."""
        absent = max(len(self.places) - len(members), 0)
        return float(betaln(1.0 + len(members), EFFECTS_ABSENT + absent)) + sum(
            float(np.log(EFFECTS[h.effect].odds / max(self.places.get(h.effect, 1), 1))) for h in members
        )

    def log_odds(self, members: Sequence[Hypothesis], hypothesis: Hypothesis) -> float:
        """ln of the odds of a set with one more effect against that without it."""
        return self.log([*members, hypothesis]) - self.log(members)
