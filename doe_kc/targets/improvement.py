"""How much of the initial error a correlation removed (thesis, Appendix D)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from doe_kc.targets.rating import Score
from doe_kc.targets.target import Target, Targets

SIGNIFICANT = 3.0
"""Standard deviations of a target within which a value does not differ from it."""


@dataclass(frozen=True)
class Improvement:
    """One characteristic before and after. percent: 100 = target met, 0 = as far as the baseline.

    counts: active or sought, and the baseline more than three standard deviations of the target away from
    it. sought: whether the search worked on it. inside: within the constraint interval; True without one.
    """

    target: Target
    baseline: float
    final: float
    sought: bool = False

    @property
    def percent(self) -> float:
        """100 (1 - |final - target| / |baseline - target|); nan for a baseline on target."""
        before = abs(self.baseline - self.target.value)
        if before == 0.0:
            return math.nan
        return 100.0 * (1.0 - abs(self.final - self.target.value) / before)

    @property
    def counts(self) -> bool:
        """Whether it enters the mean."""
        distance = abs(self.baseline - self.target.value)
        counted = self.target.active or self.sought
        return counted and distance > SIGNIFICANT * self.target.sd and distance > 0.0

    @property
    def inside(self) -> bool:
        """Whether the final value lies in the constraint interval."""
        c = self.target.constraint
        return c is None or c.low <= self.final <= c.high


def improvements(
    targets: Targets, baseline: Score, final: Score, *, sought: Targets | None = None
) -> list[Improvement]:
    """One entry a target, in its order. sought: the same targets as a search works on them."""
    searched = (targets if sought is None else sought).characteristics
    return [
        Improvement(t, float(b), float(f), s.objective is not None)
        for t, s, b, f in zip(targets.characteristics, searched, baseline.values, final.values, strict=True)
    ]


def mean_improvement(entries: list[Improvement]) -> float:
    """Mean percent over those that count; nan when none does."""
    return _mean([e.percent for e in entries if e.counts])


def exact_model_improvement(entries: list[Improvement]) -> float:
    """Mean percent over those that count that an exact model of the car shows on average; nan when none does.

    100 (1 - sqrt(2 / pi) sd / |baseline - target|), the mean distance of a Gaussian target from the truth.
    More than this is reached by fitting the noise of the targets.
    """
    share = math.sqrt(2.0 / math.pi)
    return _mean(
        [100.0 * (1.0 - share * e.target.sd / abs(e.baseline - e.target.value)) for e in entries if e.counts]
    )


def _mean(percents: list[float]) -> float:
    return sum(percents) / len(percents) if percents else math.nan
