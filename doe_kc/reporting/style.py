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
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from doe_kc.output import write_whole
from doe_kc.pictures import PNG, PictureFormat

A4 = (8.27, 11.69)
"""Portrait, inches."""
A4_LANDSCAPE = (11.69, 8.27)
DPI = 150
COMPRESSION = 3
"""Of PNG files: level 6, the usual one, takes twice the time for 5 % of the size."""

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


def ticks(count: int) -> MaxNLocator:
    """At most `count` intervals between round numbers, where Matplotlib's own choice would need the size of
    text on the paper."""
    return MaxNLocator(count, steps=(1.0, 2.0, 2.5, 5.0, 10.0))


def picture_path(path_without_suffix: Path, pictures: PictureFormat) -> Path:
    """The file of a picture. Not Path.with_suffix: it would cut a name such as "run 1.5"."""
    return path_without_suffix.with_name(f"{path_without_suffix.name}.{pictures}")


def save(fig: Figure, path_without_suffix: Path, pictures: PictureFormat = PNG, *, mark: str = "") -> Path:
    """Write one picture, PNG (150 dpi) or SVG, making the folder; returns its path.

    mark: kept in the file's head; see `picture_digest`. A picture of the other format with another mark
    shows older numbers and is removed. Raises RunError naming the path when it cannot be written (full disk,
    read-only folder).
    """
    _lay_out(fig)
    target = picture_path(path_without_suffix, pictures)
    note = f"doe_kc {mark}".strip()
    if pictures == "svg":
        svg = FigureCanvasSVG(fig)
        _write(target, lambda p: svg.print_svg(p, metadata={"Date": None, "Description": note}))  # type: ignore[no-untyped-call]
    else:
        png = FigureCanvasAgg(fig)
        words = {"Software": "doe_kc", "Description": note}
        fast = {"compress_level": COMPRESSION}
        _write(target, lambda p: png.print_png(p, metadata=words, pil_kwargs=fast))  # type: ignore[no-untyped-call]
    _remove_older(picture_path(path_without_suffix, "png" if pictures == "svg" else "svg"), note)
    return target


def _remove_older(picture: Path, note: str) -> None:
    """Only what this package wrote, as its head says."""
    try:
        with picture.open("rb") as file:
            head = file.read(8192)
        if b"doe_kc" in head and note.encode() not in head:
            picture.unlink()
    except OSError:
        return


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
