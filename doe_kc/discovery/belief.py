"""Which sizes of an effect are believed, and which are worth a name."""

from __future__ import annotations

from collections.abc import Iterable

LARGEST = 3.0
"""Typical sizes."""
RELEVANT = 0.1
"""Typical sizes below which an effect is a trace: seen, but not worth a name."""
CONFIDENT = 2.0
"""Standard deviations by which a size must be beyond either."""

Sized = Iterable[tuple[float, float]]
"""Amplitude in typical sizes, and its standard deviation."""


def believed(sizes: Sized) -> bool:
    """Whether none is surely beyond what such a part has."""
    return not any(abs(a) - CONFIDENT * sd > LARGEST for a, sd in sizes)


def matters(sizes: Sized) -> bool:
    """Whether one is surely more than a trace; an effect without a size does when it is there."""
    counted = list(sizes)
    return not counted or any(abs(a) - CONFIDENT * sd >= RELEVANT for a, sd in counted)
