"""A panel of a sheet: curves, areas and texts over two axes, drawn without a Matplotlib Axes.

An Axes takes 16 ms to make and clear, more than its curves take to draw. A panel is a rectangle of the page
in points; its artists keep their data and get one affine map to the page when the sheet is completed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import Collection, LineCollection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon
from matplotlib.transforms import (
    Affine2D,
    Bbox,
    IdentityTransform,
    Transform,
    TransformedBbox,
    blended_transform_factory,
)
from numpy.typing import ArrayLike

from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.panel_axis import PanelAxis
from doe_kc.reports.drawing.words import Across, Along, Word

Scale = Literal["data", "panel"]
"""In what a coordinate is: units of the axis, or shares of the panel's width or height."""
Dash = Literal["-", "--", ":", ""] | tuple[float, Sequence[float]]
"""Of a line, as Matplotlib's `linestyle`; "" for markers alone."""
PANEL_LINE = 1.5
"""Points of a line's width where nobody says another."""
TITLE_PAD = 6.0
"""Points between a panel and its title (Matplotlib's own)."""


@dataclass(frozen=True)
class PageBox:
    """Rectangle of the page, points from its lower left corner."""

    left: float
    bottom: float
    width: float
    height: float

    @property
    def right(self) -> float:
        """Of its right edge."""
        return self.left + self.width

    @property
    def top(self) -> float:
        """Of its upper edge."""
        return self.bottom + self.height


@dataclass(frozen=True)
class Label:
    """Name of an axis or of a panel."""

    text: str = ""
    size: float = 8.0
    weight: str = "normal"
    across: Across = "center"


@dataclass(frozen=True)
class PanelText:
    """A text at (x, y) in data or in shares of the panel, moved by (dx, dy) points."""

    x: float
    y: float
    text: str
    scales: tuple[Scale, Scale]
    shift: tuple[float, float]
    look: dict[str, Any]


class Panel:
    """Draws over `x` and `y`; panels may share an axis."""

    def __init__(self, box: PageBox, x: PanelAxis, y: PanelAxis) -> None:
        self.box, self.x, self.y = box, x, y
        self.lines: list[Line2D] = []
        self.areas: list[Patch | Collection] = []
        self.texts: list[PanelText] = []
        self.title, self.x_label, self.y_label = Label(), Label(), Label()
        self.spines = {"left": True, "bottom": True}
        self.grid = {"x": True, "y": True}
        self.marks = {"x": True, "y": True}
        self.numbers = {"x": True, "y": True}
        self.number_size = {"x": 7.0, "y": 7.0}
        self.number_angle = {"x": 0.0, "y": 0.0}
        self.right = False
        self.background: str | None = None
        self._scales: dict[int, tuple[Scale, Scale]] = {}
        self._free: set[int] = set()

    def set_title(
        self, text: str, *, size: float = 9.0, weight: str = "normal", across: Across = "center"
    ) -> None:
        """Above the panel."""
        self.title = Label(text, size, weight, across)

    def set_labels(self, x: str | None, y: str | None, size: float = 8.0) -> None:
        """Names and units of the axes; None leaves one as it is."""
        if x is not None:
            self.x_label = Label(x, size)
        if y is not None:
            self.y_label = Label(y, size)

    def plot(
        self, x: ArrayLike, y: ArrayLike, dash: Dash = "-", *, clip: bool = True,
        scales: tuple[Scale, Scale] = ("data", "data"), **look: Any,
    ) -> Line2D:  # fmt: skip
        """A line or markers; dash: as Matplotlib's `linestyle`, "" for markers alone. clip: at the edges."""
        look.setdefault("lw", PANEL_LINE)
        line = Line2D(np.atleast_1d(np.asarray(x, dtype=float)), np.atleast_1d(np.asarray(y, dtype=float)),
                      linestyle=dash, **look)  # fmt: skip
        self.lines.append(line)
        self._keep(line, scales, clip)
        self._include(line.get_xdata(), line.get_ydata(), scales)
        return line

    def vline(self, x: float, dash: Dash = "-", **look: Any) -> Line2D:
        """Over the height of the panel."""
        return self.plot([x, x], [0.0, 1.0], dash, scales=("data", "panel"), **look)

    def hline(self, y: float, dash: Dash = "-", **look: Any) -> Line2D:
        """Over the width of the panel."""
        return self.plot([0.0, 1.0], [y, y], dash, scales=("panel", "data"), **look)

    def fill_between(self, x: FloatArray, low: FloatArray, high: FloatArray, **look: Any) -> None:
        """The area between two curves over `x`."""
        outline = np.column_stack([np.concatenate([x, x[::-1]]), np.concatenate([low, high[::-1]])])
        self.add(Polygon(outline, closed=True, **{"lw": 0.0, "zorder": 1, **look}))

    def vspan(self, low: float, high: float, **look: Any) -> None:
        """A band over the height of the panel."""
        outline = [(low, 0.0), (high, 0.0), (high, 1.0), (low, 1.0)]
        self.add(Polygon(outline, closed=True, **{"lw": 0.0, **look}), scales=("data", "panel"))

    def hspan(self, low: float, high: float, **look: Any) -> None:
        """A band over the width of the panel."""
        outline = [(0.0, low), (1.0, low), (1.0, high), (0.0, high)]
        self.add(Polygon(outline, closed=True, **{"lw": 0.0, **look}), scales=("panel", "data"))

    def bars(
        self,
        y: ArrayLike,
        start: ArrayLike,
        end: ArrayLike,
        height: float,
        colors: Sequence[str],
        **look: Any,
    ) -> PolyCollection:
        """Horizontal bars about `y`, (n,), from `start` to `end`, each in its colour, as one artist."""
        at, left, right = np.broadcast_arrays(*(np.atleast_1d(v).astype(float) for v in (y, start, end)))
        low, high = at - height / 2.0, at + height / 2.0
        corners = np.stack([[left, low], [right, low], [right, high], [left, high]]).transpose(2, 0, 1)
        bars = PolyCollection(
            list(corners), facecolors=list(colors), **{"linewidths": 0.0, "zorder": 1, **look}
        )
        self.add(bars)
        self._include(corners[:, :, 0], corners[:, :, 1], ("data", "data"))
        return bars

    def segments(self, x0: ArrayLike, y0: ArrayLike, x1: ArrayLike, y1: ArrayLike, **look: Any) -> None:
        """Straight lines from (x0, y0) to (x1, y1), (n,) each, as one artist."""
        ends = np.stack([np.column_stack([x0, y0]), np.column_stack([x1, y1])], axis=1).astype(float)
        self.add(LineCollection(list(ends), **look))
        self._include(ends[:, :, 0], ends[:, :, 1], ("data", "data"))

    def add(
        self, area: Patch | Collection, scales: tuple[Scale, Scale] = ("data", "data"), *, clip: bool = True
    ) -> None:
        """Another artist with data coordinates; the limits follow polygons alone."""
        self.areas.append(area)
        self._keep(area, scales, clip)
        if isinstance(area, Polygon):
            corners = np.asarray(area.get_xy(), dtype=float)
            self._include(corners[:, 0], corners[:, 1], scales)

    def text(
        self, x: float, y: float, text: str, *, scales: tuple[Scale, Scale] = ("data", "data"),
        shift: tuple[float, float] = (0.0, 0.0), size: float = 8.0, across: Across = "left",
        along: Along = "baseline", **look: Any,
    ) -> None:  # fmt: skip
        """shift: points. look: colour, weight, family, angle and backing of a Word. Not clipped."""
        self.texts.append(
            PanelText(x, y, text, scales, shift, {"size": size, "across": across, "along": along, **look})
        )

    def place(
        self, x: float, y: float, scales: tuple[Scale, Scale] = ("data", "data")
    ) -> tuple[float, float]:
        """Points on the page."""
        across = float(self.x.shares(np.array([x]))[0]) if scales[0] == "data" else x
        along = float(self.y.shares(np.array([y]))[0]) if scales[1] == "data" else y
        return self.box.left + across * self.box.width, self.box.bottom + along * self.box.height

    def artists(self, page: Transform) -> list[Artist]:
        """Lines and areas with their map to the page, whose points `page` maps to the canvas."""
        frame = TransformedBbox(
            Bbox.from_bounds(self.box.left, self.box.bottom, self.box.width, self.box.height), page
        )
        maps: dict[tuple[Scale, Scale], Transform] = {}
        out: list[Artist] = [*self.areas, *self.lines]
        for artist in out:
            scales = self._scales[id(artist)]
            if scales not in maps:
                maps[scales] = self._map(scales) + page
            artist.set_transform(maps[scales])
            if id(artist) not in self._free:
                artist.set_clip_box(frame)
        return out

    def words(self) -> list[Word]:
        """The texts in their places on the page."""
        out = []
        for text in self.texts:
            x, y = self.place(text.x, text.y, text.scales)
            out.append(Word(x + text.shift[0], y + text.shift[1], text.text, **text.look))
        return out

    def _map(self, scales: tuple[Scale, Scale]) -> Transform:
        (x0, x1) = self.x.scaled_limits if scales[0] == "data" else (0.0, 1.0)
        (y0, y1) = self.y.scaled_limits if scales[1] == "data" else (0.0, 1.0)
        box = self.box
        affine = Affine2D().translate(-x0, -y0).scale(box.width / (x1 - x0), box.height / (y1 - y0))
        affine.translate(box.left, box.bottom)
        x = self.x.scale if scales[0] == "data" else IdentityTransform()
        y = self.y.scale if scales[1] == "data" else IdentityTransform()
        if x.is_affine and y.is_affine:
            return affine
        return blended_transform_factory(x, y) + affine

    def _keep(self, artist: Artist, scales: tuple[Scale, Scale], clip: bool) -> None:
        self._scales[id(artist)] = scales
        if not clip:
            self._free.add(id(artist))

    def _include(self, x: ArrayLike, y: ArrayLike, scales: tuple[Scale, Scale]) -> None:
        if scales[0] == "data":
            self.x.include(x)
        if scales[1] == "data":
            self.y.include(y)
