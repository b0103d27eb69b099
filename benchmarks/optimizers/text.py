"""What the page says around its tables."""

from __future__ import annotations

from collections.abc import Sequence

from optimizers.running import Result

CONDITIONS = """placeholder {size} {rating:.2f} {share:.1f}"""


def reading(runs: dict[str, Sequence[Result]]) -> list[str]:
    """Lines."""
    return []
