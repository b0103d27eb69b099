"""A page of panels in the product's style."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from operator import methodcaller
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.transforms import Affine2D, Bbox, Transform
from numpy.typing import NDArray

from doe_kc.reports.drawing.legend import Corner, Legend
from doe_kc.reports.drawing.panel import PageBox, Panel
from doe_kc.reports.drawing.panel_axis import PanelAxis
from doe_kc.reports.drawing.panel_frame import Frame
from doe_kc.reports.drawing.style import A4, DPI
from doe_kc.reports.drawing.words import POINTS, Across, Along, Word, Words, extent, with_minus_sign

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FRAME, FRAME_WIDTH, MINOR_WIDTH = "#000000", 0.8, 0.6
GRID, GRID_WIDTH = "#DDDDDD", 0.5
BACK_ORDER, GRID_ORDER, FRAME_ORDER = -1.0, 0.5, 2.5
SHEET_MARGINS = {"left": 0.125, "right": 0.9, "top": 0.88, "bottom": 0.11, "wspace": 0.2, "hspace": 0.2}


class Sheet:
    """A page whose panels are completed at its first drawing: their limits must be final then.

    No Matplotlib Figure: the import of that class with all its axes takes as long as three pages.
    """

    def __init__(self, size: tuple[float, float]) -> None:
        self.panels: list[Panel] = []
        self._dots = Affine2D().scale(DPI)
        self.page: Transform = Affine2D().scale(1.0 / POINTS) + self._dots
        self.inches, self._artists = size, list[Artist]()
        self._figure: Figure | None = None
        self.width, self.height = size[0] * POINTS, size[1] * POINTS
        self.keys: list[Legend] = []
        self.heading = ""
        self._words = Words()
        self._completed = False

    def add_panel(self, box: PageBox, x: PanelAxis | None = None, y: PanelAxis | None = None) -> Panel:
        """A panel in a rectangle of the page; x, y: axes that it shares."""
        panel = Panel(box, x or PanelAxis(), y or PanelAxis())
        self.panels.append(panel)
        return panel

    def write(
        self, x: float, y: float, text: str, size: float, across: Across = "left", along: Along = "baseline",
        **look: Any,
    ) -> None:  # fmt: skip
        """A text at shares of the page's width and height; look: colour, weight and so on of a Word."""
        self._words.entries.append(Word(x * self.width, y * self.height, text, size, across, along, **look))

    def set_heading(self, text: str, y: float, along: Along = "top", size: float = 11.0) -> None:
        """The title of the page, its middle at half the width; y: share of the height."""
        self.heading = text
        self.write(0.5, y, text, size, "center", along)

    def add_legend(
        self, handles: Sequence[Line2D | Patch], columns: int, size: float = 7.0,
        corner: Corner = ("center", "bottom"), at: tuple[float, float] | None = None, **spaces: float,
    ) -> None:  # fmt: skip
        """corner: which of its points lies at `at`, points of the page, by default in its lower middle or at
        the same edge of the page. spaces: in sizes of its text, as Matplotlib's."""
        self.keys.append(Legend(tuple(handles), columns, size, corner, at, spaces))

    @property
    def words(self) -> tuple[Word, ...]:
        """Every text of the page; completes the panels."""
        self.complete()
        return tuple(self._words.entries)

    @property
    def outside(self) -> list[str]:
        """Texts that reach beyond the page."""
        out = []
        for word in self.words:
            left, bottom, right, top = extent(word)
            if word.text.strip() and (left < 0 or bottom < 0 or right > self.width or top > self.height):
                out.append(word.text)
        return out

    def complete(self) -> None:
        """Place everything, once."""
        if self._completed:
            return
        self._completed = True
        frame = Frame()
        for panel in self.panels:
            if panel.background is not None:
                box = panel.box
                back = Rectangle((box.left, box.bottom), box.width, box.height, fc=panel.background, lw=0.0)
                self._place(back, BACK_ORDER)
            for artist in panel.artists(self.page):
                self._artists.append(artist)
            frame.add(panel)
            frame.words += panel.words()
        self._segments(frame.grid, GRID, GRID_WIDTH, GRID_ORDER)
        self._segments(frame.lines, FRAME, FRAME_WIDTH, FRAME_ORDER)
        self._segments(frame.minor, FRAME, MINOR_WIDTH, FRAME_ORDER)
        for legend in self.keys:
            artists, words = legend.artists(self.width, self.height)
            for artist in artists:
                self._place(artist, artist.get_zorder())
            frame.words += words
        self._words.entries = [with_minus_sign(w) for w in (*self._words.entries, *frame.words)]
        parent = _Parent(*self.inches)
        for artist in self._artists:
            artist.set_figure(parent)  # type: ignore[arg-type]  # asked for its size alone
        self._artists.append(self._words)

    def _segments(self, segments: Sequence[Any], color: str, width: float, order: float) -> None:
        if segments:
            self._place(LineCollection(segments, colors=color, linewidths=width), order)

    def _place(self, artist: Artist, order: float) -> None:
        artist.set_zorder(order)
        artist.set_transform(self.page)
        self._artists.append(artist)

    def pixels(self) -> NDArray[np.uint8]:
        """(height, width, 3) from the upper left corner, DPI dots an inch."""
        renderer = RendererAgg(self.inches[0] * DPI, self.inches[1] * DPI, DPI)  # type: ignore[no-untyped-call]
        self._dots.clear().scale(DPI)
        for artist in self._ordered():
            artist.draw(renderer)
        out: NDArray[np.uint8] = np.asarray(renderer.buffer_rgba(), dtype=np.uint8)[:, :, :3]  # type: ignore[no-untyped-call]
        return out

    def figure(self) -> Figure:
        """The page for a vector format, 72 dots an inch; the same one every time."""
        from matplotlib.figure import Figure

        self._dots.clear().scale(POINTS)
        if self._figure is None:
            self._figure = Figure(figsize=self.inches, dpi=POINTS)
            self._words.set_figure(self._figure)
            self._figure.add_artist(_Page(self._ordered()[1:]))  # a figure has a ground of its own
        return self._figure

    def _ordered(self) -> list[Artist]:
        """On a white ground, the upper ones last."""
        self.complete()
        ground = Rectangle((0.0, 0.0), self.width, self.height, fc="white", lw=0.0)
        ground.set_transform(self.page)
        return [ground, *sorted(self._artists, key=methodcaller("get_zorder"))]


class _Page(Artist):
    """All that is on a sheet, as one artist of a figure."""

    def __init__(self, content: Sequence[Artist]) -> None:
        super().__init__()
        self._content = content

    def draw(self, renderer: RendererBase) -> None:
        for artist in self._content:
            artist.draw(renderer)


class _Parent:
    """What artists ask of the figure that they are on: its size, its dots an inch, how images are merged."""

    suppressComposite = None  # Matplotlib's name, asked by what is drawn as pixels in a vector file

    def __init__(self, width: float, height: float) -> None:
        self.dpi, self.bbox = DPI, Bbox.from_bounds(0.0, 0.0, width * DPI, height * DPI)

    def get_figure(self, root: bool = True) -> _Parent:
        """Itself."""
        return self


def sheet(
    rows: int,
    columns: int,
    *,
    size: tuple[float, float] = A4,
    width_ratios: Sequence[float] | None = None,
    height_ratios: Sequence[float] | None = None,
    share_x: bool = True,
    margins: Mapping[str, float],
) -> tuple[Sheet, NDArray[Any]]:
    """A page and its (rows, columns) panels.

    size: inches. share_x: one horizontal axis for all panels, its numbers below the last row. margins: left,
        right, top, bottom in shares of the page; wspace, hspace between panels in shares of their mean size.
    """
    page = Sheet(size)
    room = {**SHEET_MARGINS, **margins}
    lefts, widths = _cells(room["left"], room["right"], room["wspace"], width_ratios or (1.0,) * columns)
    downs, heights = _cells(
        1 - room["top"], 1 - room["bottom"], room["hspace"], height_ratios or (1.0,) * rows
    )
    shared = PanelAxis() if share_x else None
    panels = np.empty((rows, columns), dtype=object)
    for i in range(rows):
        for j in range(columns):
            bottom = (1.0 - downs[i] - heights[i]) * page.height
            box = PageBox(lefts[j] * page.width, bottom, widths[j] * page.width, heights[i] * page.height)
            panels[i, j] = page.add_panel(box, shared)
            panels[i, j].numbers["x"] = not share_x or i == rows - 1
    return page, panels


def _cells(
    start: float, end: float, space: float, ratios: Sequence[float]
) -> tuple[list[float], list[float]]:
    """Starts and lengths; space: between them, in shares of their mean length."""
    count = len(ratios)
    mean = (end - start) / (count + space * (count - 1))
    lengths = [mean * count * r / sum(ratios) for r in ratios]
    starts = [start + sum(lengths[:k]) + k * space * mean for k in range(count)]
    return starts, lengths
