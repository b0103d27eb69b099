"""Whether the last set of effects explains the records at all, apart from which effects are in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from doe_kc.discovery.screening.disagreement import Map
from doe_kc.discovery.thresholds import HELD_OUT_LIMIT, NOISE_CHANCE, NOISE_DRAWS, UNLISTED
from doe_kc.discovery.verdict.held_out import HeldOut


@dataclass(frozen=True)
class Adequacy:
    """How often noise alone leaves as much as the last set of effects does."""

    map_chance: float
    """Share of cars in which noise alone leaves as large a disagreement on the map, at least
    1 / NOISE_DRAWS."""
    held_out_chance: float | None
    """Share of cars in which it gives the worst of as many load cases held out as large an RMS; None where
    none was held out."""
    worst: HeldOut | None
    """The load case with the largest excess of its RMS."""

    @property
    def holds(self) -> bool:
        """Whether noise alone explains what remains, on the map and on load cases held out."""
        predicted = self.worst is None or self.worst.law_granted.excess <= HELD_OUT_LIMIT
        return self.map_chance >= NOISE_CHANCE and predicted

    @property
    def unlisted(self) -> float | None:
        """Largest probability of something that the library does not list; None where the set does not hold.

        With the odds before the records and a Bayes factor of at most 1 / (-e p ln p), p the smaller chance
        of the two (T. Sellke, M. J. Bayarri, J. O. Berger, The American Statistician 55, 2001).
        """
        if not self.holds:
            return None
        return float(UNLISTED / (UNLISTED + self.support))

    @property
    def support(self) -> float:
        """Least Bayes factor of the set against something unlisted, -e p ln p, 1 where p is above 1/e."""
        chances = [c for c in (self.map_chance, self.held_out_chance) if c is not None]
        p = max(min(1.0, len(chances) * min(chances)), 1.0 / NOISE_DRAWS)
        return float(-np.e * p * np.log(p)) if p < np.exp(-1.0) else 1.0


def adequacy(remaining: Map, held_out: Sequence[HeldOut]) -> Adequacy:
    """remaining: residual map of the last set. held_out: every load case predicted from the others."""
    chance = max(remaining.chance, 1.0 / NOISE_DRAWS)
    worst = max(held_out, key=lambda h: h.law_granted.excess, default=None)
    if worst is None:
        return Adequacy(chance, None, None)
    alone = float(ndtr(-worst.law_granted.excess))
    return Adequacy(chance, min(1.0, len(held_out) * alone), worst)
