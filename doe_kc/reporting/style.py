"""One look for every figure of the product; no global state, any backend, no display needed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from numpy.typing import NDArray

from doe_kc.output import write_whole

A4 = (8.27, 11.69)
"""Portrait, inches."""
A4_LANDSCAPE = (11.69, 8.27)
DPI = 150

PALETTE: Mapping[str, str] = {
    "black": "#000000",
    "orange": "#E69F00",
    "sky": "#56B4E9",
    "green": "#009E73",
    "yellow": "#F0E442",
    "blue": "#0072B2",
    "vermillion": "#D55E00",
    "purple": "#CC79A7",
    "grey": "#999999",
}
"""Okabe & Ito (2008), distinguishable with the common kinds of colour blindness."""

CYCLE = tuple(PALETTE[k] for k in ("blue", "vermillion", "green", "orange", "purple", "sky", "black"))

RC: Mapping[str, object] = {
    "font.size": 8.0,
    "axes.titlesize": 9.0,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.2,
    "svg.fonttype": "none",
    "svg.hashsalt": "doe_kc",
}


def figure(
    rows: int,
    columns: int,
    *,
    size: tuple[float, float] = A4,
    width_ratios: Sequence[float] | None = None,
    share_x: bool = True,
    margins: Mapping[str, float] | None = None,
) -> tuple[Figure, NDArray[Any]]:
    """A figure and its (rows, columns) axes in the product's style, laid out so that nothing is cut off.

    size: inches. share_x: one horizontal axis for all panels. margins: of `subplots_adjust`, for equal
        panels that need no solver for their layout, which takes longer than drawing them.
    """
    with rc_context(dict(RC)):  # type: ignore[arg-type]  # matplotlib types the keys as literals
        fig = Figure(figsize=size, dpi=DPI, layout="constrained" if margins is None else None)
        if margins is not None:
            fig.subplots_adjust(**margins)
        FigureCanvasAgg(fig)
        axes = fig.subplots(rows, columns, squeeze=False, sharex=share_x, width_ratios=width_ratios)
    for ax in axes.flat:
        ax.set_prop_cycle(color=CYCLE)
    return fig, axes


def label(ax: Axes, x: str | None, y: str | None) -> None:
    """Axis labels; None leaves one out."""
    if x is not None:
        ax.set_xlabel(x)
    if y is not None:
        ax.set_ylabel(y)


def save_png(fig: Figure, path_without_suffix: Path) -> Path:
    """Write PNG alone (150 dpi), for the many sheets of a series; raises as `save`."""
    _lay_out(fig)
    canvas = FigureCanvasAgg(fig)
    # Not Path.with_suffix: it would cut a name such as "run 1.5".
    target = path_without_suffix.with_name(f"{path_without_suffix.name}.png")
    return _write(target, lambda p: canvas.print_png(p, metadata={"Software": "doe_kc"}))  # type: ignore[no-untyped-call]


def save(fig: Figure, path_without_suffix: Path) -> tuple[Path, Path]:
    """Write PNG (150 dpi) and SVG, making the folder; returns both paths.

    Raises RunError naming the path when it cannot be written (full disk, read-only folder).
    """
    png = save_png(fig, path_without_suffix)
    canvas = FigureCanvasSVG(fig)
    target = path_without_suffix.with_name(f"{path_without_suffix.name}.svg")
    return png, _write(target, lambda p: canvas.print_svg(p, metadata={"Date": None}))  # type: ignore[no-untyped-call]


def _lay_out(fig: Figure) -> None:
    """Lay out once: it costs more than drawing, and savefig would do it for each file, twice."""
    engine = fig.get_layout_engine()
    if engine is not None:
        engine.execute(fig)
        fig.set_layout_engine("none")


def _write(target: Path, draw: Callable[[Path], object]) -> Path:
    """Let `draw` write `target` as a whole; no dates inside, so that equal results are equal files."""
    with rc_context(dict(RC)):  # type: ignore[arg-type]
        return write_whole(target, draw)
