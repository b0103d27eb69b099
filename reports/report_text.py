"""Markdown tables and figures in words, shared by the reports on correlation."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def number(value: float, digits: int = 3) -> str:
    """Significant digits without an exponent."""
    return f"{float(f'{value:.{digits}g}'):g}" if np.isfinite(value) else "-"


def spread(values: Sequence[float], digits: int = 3) -> str:
    """Median (lowest to highest)."""
    known = np.array(values, dtype=float)
    middle, low, high = np.median(known), known.min(), known.max()
    return f"{number(middle, digits)} ({number(low, digits)} to {number(high, digits)})"


def first_times(values: Sequence[int | None]) -> str:
    """Median and latest evaluation at which the runs became feasible, and how many never did."""
    known = [v for v in values if v is not None]
    if not known:
        return "never"
    never = len(values) - len(known)
    return f"{np.median(known):.0f}, at most {max(known)}" + (f"; {never} never" if never else "")
