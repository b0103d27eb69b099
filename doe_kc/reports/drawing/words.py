"""Many short texts of a figure as one artist.

Matplotlib lays out each of its Text objects anew at every drawing, 1.2 ms each: half of the time of a sheet
with many panels. Here the size of a text is measured once a process.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import RendererAgg, get_hinting_flag
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.font_manager import FontProperties, findfont, get_font
from matplotlib.path import Path
from matplotlib.text import Text
from matplotlib.transforms import Affine2D, IdentityTransform
from numpy.typing import NDArray

from doe_kc.reports.drawing.style import DPI

POINTS = 72.0
"""Points an inch."""
LINE_SPACING = 1.2
"""Heights of a line from one baseline to the next (Matplotlib's own)."""
WORD_EDGE = 2
"""Pixels about the image of a line, as letters reach beyond their measured size."""
SUBPIXEL = 1.0 / 64.0
"""Pixels, FreeType's unit."""
WORD_ORDER = 3.0
"""Above lines and areas, as Matplotlib's texts."""

Across = Literal["left", "center", "right"]
Along = Literal["top", "center", "bottom", "baseline"]
SHARE = {"left": 0.0, "center": 0.5, "right": 1.0}
HYPHEN_BEFORE_NUMBER = re.compile(r"(?<![\w.\]])-(?=\.?\d)|(?<=\de)-(?=\d)")
"""A hyphen that stands for a minus: not within a name such as `run-2`."""


@dataclass(frozen=True)
class Word:
    """A text of one or more lines at (x, y), points from the page's lower left corner.

    across, along: which of its edges is there. angle: degrees, about that point, after the alignment.
    backing: colour of a box behind it, 80 % opaque. formula: whether dollars enclose a formula.
    """

    x: float
    y: float
    text: str
    size: float
    across: Across = "left"
    along: Along = "baseline"
    color: str = "#000000"
    weight: str = "normal"
    family: str = "sans-serif"
    angle: float = 0.0
    backing: str | None = None
    formula: bool = False


def with_minus_sign(word: Word) -> Word:
    """The word with true minus signs before its numbers."""
    if "-" not in word.text or word.formula:
        return word
    return replace(word, text=HYPHEN_BEFORE_NUMBER.sub("\N{MINUS SIGN}", word.text))


@dataclass(frozen=True)
class LineImage:
    """A horizontal line of text, drawn once.

    width, height, descent: points, the height of a line with ascenders at least. coverage: (rows, columns)
    uint8 from the upper left corner, 255 where a letter covers a pixel wholly. left, below: pixels from the
    lower left corner of the coverage to the left end of the baseline.
    """

    width: float
    height: float
    descent: float
    coverage: NDArray[np.uint8]
    left: int
    below: int


@lru_cache(maxsize=1)
def _formula_renderer() -> RendererAgg:
    return RendererAgg(1.0, 1.0, DPI)  # type: ignore[no-untyped-call]


@lru_cache(maxsize=8192)
def line_image(line: str, size: float, weight: str, family: str, formula: bool) -> LineImage:
    """A line as FreeType draws it, all letters in one call: Matplotlib's draw_text takes 0.2 ms a letter."""
    image = _formula(line, size, weight, family) if formula else _plain(line, size, weight, family)
    if line == "lp":
        return image
    usual = line_image("lp", size, weight, family, False)
    return replace(image, height=max(image.height, usual.height), descent=max(image.descent, usual.descent))


def _plain(line: str, size: float, weight: str, family: str) -> LineImage:
    font = get_font(_font_files(weight, family))
    font.clear()
    font.set_size(size, DPI)
    font.set_text(line, 0.0, flags=get_hinting_flag())  # type: ignore[no-untyped-call]
    width, height, descent = (v * SUBPIXEL for v in (*font.get_width_height(), font.get_descent()))
    font.draw_glyphs_to_bitmap(antialiased=True)
    coverage = np.array(font.get_image(), dtype=np.uint8)
    left = -round(font.get_bitmap_offset()[0] * SUBPIXEL)  # to a pixel: hinting moves the first letter
    below = coverage.shape[0] - math.trunc(height - descent) - 1  # FreeType's bitmap has a free row on top
    pixels = DPI / POINTS
    return LineImage(width / pixels, height / pixels, descent / pixels, coverage, left, below)


def _formula(line: str, size: float, weight: str, family: str) -> LineImage:
    font = FontProperties(family=family, size=size, weight=weight)
    measure = _formula_renderer().get_text_width_height_descent
    width, height, descent = measure(line, font, True)  # type: ignore[no-untyped-call]
    below = math.ceil(descent) + WORD_EDGE
    wide, tall = math.ceil(width) + 2 * WORD_EDGE, below + math.ceil(height - descent) + WORD_EDGE
    renderer = RendererAgg(wide, tall, DPI)  # type: ignore[no-untyped-call]
    renderer.draw_text(renderer.new_gc(), WORD_EDGE, tall - below, line, font, 0.0, ismath=True)  # type: ignore[no-untyped-call]
    coverage = np.array(renderer.buffer_rgba(), dtype=np.uint8)[:, :, 3]  # type: ignore[no-untyped-call]
    pixels = DPI / POINTS
    return LineImage(width / pixels, height / pixels, descent / pixels, coverage, WORD_EDGE, below)


@lru_cache(maxsize=64)
def _font_files(weight: str, family: str) -> str:
    return str(findfont(FontProperties(family=family, weight=weight)))


def line_size(line: str, size: float, weight: str, family: str, formula: bool) -> tuple[float, float, float]:
    """Width, height and descent of one line in points, the height of a line with ascenders at least."""
    image = line_image(line, size, weight, family, formula)
    return image.width, image.height, image.descent


@lru_cache(maxsize=2048)
def _image(
    line: str, size: float, weight: str, family: str, formula: bool, color: str, angle: float
) -> tuple[NDArray[np.uint8], int, int]:
    """A line as (height, width, 4) pixels from the lower left corner, and those from there to its baseline's
    left end. Sheets of a series share most of their words."""
    drawn = line_image(line, size, weight, family, formula)
    if angle % 90.0:
        return _turned_image(line, size, weight, family, formula, color, angle)
    coverage, left, below = drawn.coverage[::-1], drawn.left, drawn.below
    for _ in range(round(angle / 90.0) % 4):  # anticlockwise on the page, rows upwards
        rows = coverage.shape[0]
        coverage, left, below = np.rot90(coverage, -1), rows - below, left
    image = np.empty((*coverage.shape, 4), dtype=np.uint8)
    image[:, :, :3] = np.round(255.0 * np.array(to_rgb(color)))
    image[:, :, 3] = coverage
    return image, left, below


def _turned_image(
    line: str, size: float, weight: str, family: str, formula: bool, color: str, angle: float
) -> tuple[NDArray[np.uint8], int, int]:
    """As `_image`, at any angle."""
    width, height, descent = (v * DPI / POINTS for v in line_size(line, size, weight, family, formula))
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    corners = [(x, y) for x in (0.0, width) for y in (-descent, height - descent)]
    xs, ys = [c * x - s * y for x, y in corners], [s * x + c * y for x, y in corners]
    left, below = math.ceil(-min(xs)) + WORD_EDGE, math.ceil(-min(ys)) + WORD_EDGE
    wide, tall = left + math.ceil(max(xs)) + WORD_EDGE, below + math.ceil(max(ys)) + WORD_EDGE
    renderer = RendererAgg(wide, tall, DPI)  # type: ignore[no-untyped-call]
    gc = renderer.new_gc()
    gc.set_foreground(to_rgba(color), isRGBA=True)
    font = FontProperties(family=family, size=size, weight=weight)
    renderer.draw_text(gc, left, tall - below, line, font, angle, ismath=formula)  # type: ignore[no-untyped-call]
    image = np.array(renderer.buffer_rgba(), dtype=np.uint8)  # type: ignore[no-untyped-call]
    return image[::-1], left, below


def text_width(text: str, size: float, weight: str = "normal", family: str = "sans-serif") -> float:
    """Points of the widest line."""
    return max(line_size(line, size, weight, family, False)[0] for line in text.split("\n"))


def lines(word: Word) -> Iterator[tuple[str, float, float]]:
    """Every line with the place of its baseline's left end from (x, y), points, before the rotation."""
    parts = word.text.split("\n")
    look = (word.size, word.weight, word.family)
    sizes = [line_size(p, *look, word.formula) for p in parts]
    _, usual, below = line_size("lp", *look, False)
    least = (usual - below) * LINE_SPACING
    baselines = [0.0]
    for (_, _, above), (_, height, descent) in pairwise(sizes):
        baselines.append(baselines[-1] - above - max(least, (height - descent) * LINE_SPACING))
    top, bottom = sizes[0][1] - sizes[0][2], baselines[-1] - sizes[-1][2]
    at = {"top": top, "bottom": bottom, "center": (top + bottom) / 2.0, "baseline": baselines[-1]}[word.along]
    for part, (width, _, _), baseline in zip(parts, sizes, baselines, strict=True):
        yield part, -SHARE[word.across] * width, baseline - at


def extent(word: Word) -> tuple[float, float, float, float]:
    """Left, bottom, right, top in points; of a word turned by a multiple of 90 degrees."""
    look = (word.size, word.weight, word.family, word.formula)
    corners = []
    for line, dx, dy in lines(word):
        width, height, descent = line_size(line, *look)
        corners += [(dx, dy - descent), (dx + width, dy - descent + height)]
    c, s = math.cos(math.radians(word.angle)), math.sin(math.radians(word.angle))
    xs = [word.x + c * dx - s * dy for dx, dy in corners]
    ys = [word.y + s * dx + c * dy for dx, dy in corners]
    return min(xs), min(ys), max(xs), max(ys)


class Words(Artist):
    """Draws a list of words; `entries` may grow until then."""

    def __init__(self) -> None:
        super().__init__()
        self.entries: list[Word] = []
        self.set_zorder(WORD_ORDER)
        self.set_transform(IdentityTransform())

    def draw(self, renderer: RendererBase) -> None:
        """Pixels go through the measured sizes. A vector format gets Matplotlib's texts, which keep their
        alignment with whatever font the viewer has."""
        show = self._show if isinstance(renderer, RendererAgg) and renderer.dpi == DPI else self._show_as_text
        for word in self.entries:
            if word.text:
                show(renderer, word)

    def _show(self, renderer: RendererBase, word: Word) -> None:
        pixels = DPI / POINTS
        gc = renderer.new_gc()
        try:
            if word.backing is not None:
                _back(renderer, gc, word, word.backing, pixels)
            c, s = math.cos(math.radians(word.angle)), math.sin(math.radians(word.angle))
            look = (word.size, word.weight, word.family, word.formula, word.color, word.angle)
            for line, dx, dy in lines(word):
                x, y = word.x + c * dx - s * dy, word.y + s * dx + c * dy
                image, left, below = _image(line, *look)
                renderer.draw_image(gc, round(x * pixels) - left, round(y * pixels) - below, image)
        finally:
            gc.restore()

    def _show_as_text(self, renderer: RendererBase, word: Word) -> None:
        figure = self.get_figure(root=True)
        if figure is None:
            return
        look: dict[str, Any] = {"fontsize": word.size, "color": word.color, "weight": word.weight}
        if word.family != "sans-serif":
            look["family"] = word.family
        if word.backing is not None:
            look["bbox"] = {"facecolor": word.backing, "alpha": 0.8, "lw": 0.0, "pad": 1.0}
        text = Text(
            word.x, word.y, word.text, ha=word.across, va=word.along, rotation=word.angle,
            rotation_mode="anchor", parse_math=word.formula, **look,
            transform=Affine2D().scale(1.0 / POINTS) + figure.dpi_scale_trans,
        )  # fmt: skip
        text.set_figure(figure)
        text.draw(renderer)


def _back(renderer: RendererBase, gc: Any, word: Word, backing: str, pixels: float) -> None:
    left, bottom, right, top = extent(word)
    box = Path([(left - 1, bottom - 1), (right + 1, bottom - 1), (right + 1, top + 1), (left - 1, top + 1)])
    gc.set_linewidth(0.0)
    gc.set_alpha(0.8)
    renderer.draw_path(gc, box, Affine2D().scale(pixels), to_rgba(backing, 0.8))
    gc.set_alpha(1.0)
