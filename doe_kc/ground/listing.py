"""Lists in sentences."""

from __future__ import annotations

from collections.abc import Sequence


def first_of(words: Sequence[str], most: int, *, separator: str = ", ") -> str:
    """The words, of more than `most` (> 0) the first and how many others there are: `a, b and 3 more`."""
    if len(words) <= most:
        return separator.join(words)
    return f"{separator.join(words[:most])} and {len(words) - most} more"
