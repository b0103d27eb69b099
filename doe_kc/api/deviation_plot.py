"""Characteristics as points: how far from their targets, in half widths of their intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from doe_kc.api.axes import axes_or_new
from doe_kc.ground.typing import FloatArray

LINEAR = 1.0
"""Half widths up to which the scale is linear: the interval itself."""


def draw_deviations(
    labels: Sequence[str], series: Mapping[str, tuple[FloatArray, str]], ax: Axes | None
) -> Axes:
    """One row a characteristic. series: name -> ((n,) deviations from the target, colour)."""
    ax = axes_or_new(ax, (6.4, 1.6 + 0.21 * len(labels)))
    places = np.arange(len(labels))
    ax.axvspan(-1.0, 1.0, color="#E3F1EA", lw=0, label="constraint interval", zorder=0)
    ax.axvline(0.0, color="black", lw=0.8, zorder=1)
    for name, (values, colour) in series.items():
        ax.plot(values, places, "o", ms=4.5, color=colour, label=name, zorder=3)
    ax.set_xscale("symlog", linthresh=LINEAR, linscale=1.0)
    widest = max((float(np.nanmax(np.abs(v), initial=0.0)) for v, _ in series.values()), default=0.0)
    ax.set_xlim(-1.5 * max(widest, 2.0), 1.5 * max(widest, 2.0))
    ax.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    ax.set_yticks(places, labels, fontsize="small")
    ax.set_ylim(len(labels) - 0.5, -0.5)
    ax.grid(axis="y", color="#DDDDDD", lw=0.5)
    ax.set_xlabel("deviation from the target [half widths of the interval]")
    ax.legend(
        fontsize="small",
        loc="upper center",
        bbox_to_anchor=(0.5, -0.55 / (0.21 * len(labels) + 0.6)),
        ncols=3,
    )
    return ax
