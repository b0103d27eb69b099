"""Shares with honest intervals, and how far stated probabilities can be trusted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

Z95 = 1.959963984540054


@dataclass(frozen=True)
class Share:
    """hits of total, with the Wilson interval of 95 %."""

    hits: int
    total: int

    @property
    def value(self) -> float:
        """nan of nothing."""
        return self.hits / self.total if self.total else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """(low, high). Source: Wilson, JASA 22 (1927) 209."""
        return wilson(self.hits, self.total)

    def __str__(self) -> str:
        if not self.total:
            return "-"
        low, high = self.interval
        return f"{self.hits}/{self.total} = {100 * self.value:.0f} % ({100 * low:.0f}-{100 * high:.0f})"


def share(flags: Sequence[bool]) -> Share:
    """Of true ones."""
    return Share(sum(flags), len(flags))


def wilson(hits: int, total: int, z: float = Z95) -> tuple[float, float]:
    """Interval of a binomial share; (0, 1) of nothing."""
    if not total:
        return 0.0, 1.0
    p = hits / total
    centre = (p + z**2 / (2 * total)) / (1 + z**2 / total)
    half = z / (1 + z**2 / total) * math.sqrt(p * (1 - p) / total + z**2 / (4 * total**2))
    low = 0.0 if hits == 0 else max(0.0, centre - half)
    high = 1.0 if hits == total else min(1.0, centre + half)
    return low, high


Believed = Sequence[tuple[float, bool]]
"""(stated probability, whether it was right)."""


def brier(believed: Believed) -> float:
    """Mean squared difference of probability and outcome; 0 is perfect, 0.25 a coin."""
    if not believed:
        return math.nan
    return sum((p - right) ** 2 for p, right in believed) / len(believed)


@dataclass(frozen=True)
class Bin:
    """Statements whose probability lies in [low, high): how sure on average, and how many were right."""

    low: float
    high: float
    stated: float
    right: Share


def reliability(
    believed: Believed, edges: Sequence[float] = (0, 0.5, 0.7, 0.9, 0.95, 0.99, 1.0)
) -> list[Bin]:
    """Bins that hold anything; the last one includes its upper edge."""
    out = []
    for low, high in pairwise(edges):
        inside = [(p, r) for p, r in believed if low <= p < high or (p == high == edges[-1])]
        if inside:
            stated = sum(p for p, _ in inside) / len(inside)
            out.append(Bin(low, high, stated, share([r for _, r in inside])))
    return out


def calibration_error(believed: Believed) -> float:
    """Expected calibration error over `reliability`'s bins."""
    if not believed:
        return math.nan
    bins = reliability(believed)
    return sum(b.right.total * abs(b.stated - b.right.value) for b in bins) / len(believed)
