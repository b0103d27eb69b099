"""One look for every figure of the product; no global state, any backend, no display needed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import IO, TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from doe_kc.ground.output import write_whole
from doe_kc.ground.picture_format import PNG, PictureFormat
from doe_kc.reports.drawing.png import write_png

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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


class Picture(Protocol):
    """A page that can be drawn."""

    def pixels(self) -> NDArray[np.uint8]:
        """(height, width, 3) from the upper left corner, DPI dots an inch."""

    def figure(self) -> Figure:
        """For a vector format."""


def save(
    fig: Picture | Figure, path_without_suffix: Path, pictures: PictureFormat = PNG, *, mark: str = ""
) -> Path:
    """Write one picture, PNG (150 dpi) or SVG, making the folder; returns its path.

    mark: kept in the file's head; see `picture_digest`. A picture of the other format with another mark
    shows older numbers and is removed. Raises RunError naming the path when it cannot be written (full disk,
    read-only folder).
    """
    target = picture_path(path_without_suffix, pictures)
    note = f"doe_kc {mark}".strip()
    if pictures == "svg":
        write_whole(target, lambda p: _write_svg_file(fig, p, note))
    else:
        words = {"Software": "doe_kc", "Description": note}
        write_whole(target, lambda p: write_png(p, _pixels(fig), DPI, words=words))
    _remove_older(picture_path(path_without_suffix, "png" if pictures == "svg" else "svg"), note)
    return target


def write_svg(fig: Picture | Figure, stream: IO[bytes], note: str | None = None) -> None:
    """No dates inside, so that equal results are equal files; note: kept in the file's head."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    canvas = FigureCanvasSVG(_figure(fig))
    with rc_context(dict(RC)):  # type: ignore[arg-type]  # matplotlib types the keys as literals
        canvas.print_svg(stream, metadata={"Date": None, "Description": note})  # type: ignore[no-untyped-call]


def _write_svg_file(fig: Picture | Figure, path: Path, note: str) -> None:
    with path.open("wb") as file:
        write_svg(fig, file, note)


def _figure(fig: Picture | Figure) -> Figure:
    from matplotlib.figure import Figure

    return fig if isinstance(fig, Figure) else fig.figure()


def _pixels(fig: Picture | Figure) -> NDArray[np.uint8]:
    """(height, width, 3); the page is opaque, so that its alpha says nothing."""
    if hasattr(fig, "pixels"):
        return fig.pixels()
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(_figure(fig))
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
