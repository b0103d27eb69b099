"""Which sizes of an effect are believed, and which are worth a name."""

from __future__ import annotations

from collections.abc import Iterable

from doe_kc.discovery.thresholds import CONFIDENT, RELEVANT
from doe_kc.effects.hypothesis import Size

Sized = Iterable[tuple[Size, float, float]]
"""Amplitude of a size in typical ones, and its standard deviation."""


def believed(sizes: Sized) -> bool:
    """Whether none is surely beyond what such a part has."""
    return not any(abs(a) - CONFIDENT * sd > size.most for size, a, sd in sizes)


def matters(sizes: Sized) -> bool:
    """Whether one is surely more than a trace; an effect without a size does when it is there."""
    counted = list(sizes)
    return not counted or any(abs(a) - CONFIDENT * sd >= RELEVANT for _, a, sd in counted)
