"""Titles and legends of the reports' figures, in the product's sizes."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes


def title(ax: Axes, text: str) -> None:
    """Title of a panel."""
    ax.set_title(text, fontsize=9)


def legend(ax: Axes, place: str, **look: Any) -> None:
    """Legend inside a panel, on a ground that curves do not shine through."""
    ax.legend(loc=place, fontsize=7, frameon=True, framealpha=0.9, edgecolor="none", **look)
