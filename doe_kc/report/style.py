"""One look for every figure of the product; no global state, any backend, no display needed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from numpy.typing import NDArray

from doe_kc.ground.output import write_whole
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.report.png import write_png

MARKERS = "osD^vPX"

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

BASELINE_COLOUR, FINAL_COLOUR = PALETTE["orange"], PALETTE["blue"]
"""Of an axle before and after a correlation, in every picture."""
COLOUR_CYCLE = tuple(PALETTE[k] for k in ("blue", "vermillion", "green", "orange", "purple", "sky", "black"))

RC: Mapping[str, object] = {"svg.fonttype": "none", "svg.hashsalt": "doe_kc"}
"""SVG: texts that can be searched and edited, and the same names of its parts every time."""


def picture_path(path_without_suffix: Path, pictures: PictureFormat) -> Path:
    """The file of a picture. Not Path.with_suffix: it would cut a name such as "run 1.5"."""
    return path_without_suffix.with_name(f"{path_without_suffix.name}.{pictures}")


def save(fig: Figure, path_without_suffix: Path, pictures: PictureFormat = PNG, *, mark: str = "") -> Path:
    """Write one picture, PNG (150 dpi) or SVG, making the folder; returns its path.

    mark: kept in the file's head; see `picture_digest`. A picture of the other format with another mark
    shows older numbers and is removed. Raises RunError naming the path when it cannot be written (full disk,
    read-only folder).
    """
    target = picture_path(path_without_suffix, pictures)
    note = f"doe_kc {mark}".strip()
    if pictures == "svg":
        svg = FigureCanvasSVG(fig)
        _write(target, lambda p: svg.print_svg(p, metadata={"Date": None, "Description": note}))  # type: ignore[no-untyped-call]
    else:
        canvas = FigureCanvasAgg(fig)
        _write(
            target,
            lambda p: write_png(p, _pixels(canvas), DPI, words={"Software": "doe_kc", "Description": note}),
        )
    _remove_older(picture_path(path_without_suffix, "png" if pictures == "svg" else "svg"), note)
    return target


def _pixels(canvas: FigureCanvasAgg) -> NDArray[np.uint8]:
    """(height, width, 3); the page is opaque, so that its alpha says nothing."""
    canvas.draw()  # type: ignore[no-untyped-call]
    return np.asarray(canvas.buffer_rgba(), dtype=np.uint8)[:, :, :3]  # type: ignore[no-untyped-call]


def _remove_older(picture: Path, note: str) -> None:
    """Only what this package wrote, as its head says."""
    try:
        with picture.open("rb") as file:
            head = file.read(8192)
        if b"doe_kc" in head and note.encode() not in head:
            picture.unlink()
    except OSError:
        return


def _write(target: Path, draw: Callable[[Path], object]) -> Path:
    """Let `draw` write `target` as a whole; no dates inside, so that equal results are equal files."""
    with rc_context(dict(RC)):  # type: ignore[arg-type]
        return write_whole(target, draw)
