"""A legend in points of the page; Matplotlib's takes 40 ms to lay out eight words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from matplotlib.artist import Artist
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from doe_kc.reports.drawing.words import Across, Word, text_width

Corner = tuple[Across, Literal["top", "bottom"]]
SPACES: Mapping[str, float] = {
    "handlelength": 2.0, "handleheight": 0.7, "handletextpad": 0.8, "columnspacing": 2.0, "labelspacing": 0.5,
    "borderpad": 0.4, "borderaxespad": 0.5,
}  # fmt: skip
"""In sizes of the text (Matplotlib's own)."""
LEGEND_LINE = 1.0
"""Height of a row, in sizes of the text."""
LEGEND_ORDER = 5.0


@dataclass(frozen=True)
class Legend:
    """handles: with label, columns filled one after the other. at: see `Sheet.add_legend`."""

    handles: tuple[Line2D | Patch, ...]
    columns: int
    size: float
    corner: Corner
    at: tuple[float, float] | None = None
    spaces: Mapping[str, float] = field(default_factory=dict)

    @property
    def labels(self) -> list[str]:
        """Words of the handles."""
        return [str(h.get_label()) for h in self.handles]

    def artists(self, page_width: float, page_height: float) -> tuple[list[Artist], list[Word]]:
        """Handles and words in their places."""
        space = {k: v * self.size for k, v in {**SPACES, **self.spaces}.items()}
        parts = _split(list(self.handles), self.columns)
        widths = [max(text_width(str(h.get_label()), self.size) for h in part) for part in parts]
        widths = [w + space["handlelength"] + space["handletextpad"] for w in widths]
        step = LEGEND_LINE * self.size + space["labelspacing"]
        wide = sum(widths) + space["columnspacing"] * (len(parts) - 1)
        tall = step * max(map(len, parts)) - space["labelspacing"]
        left, top = self._corner(
            wide, tall, space["borderpad"] + space["borderaxespad"], page_width, page_height
        )
        artists: list[Artist] = []
        words: list[Word] = []
        for part, width in zip(parts, widths, strict=True):
            for k, handle in enumerate(part):
                middle = top - k * step - LEGEND_LINE * self.size / 2.0
                artists.append(_key(handle, left, middle, space))
                start = left + space["handlelength"] + space["handletextpad"]
                base = middle - 0.35 * self.size
                words.append(Word(start, base, str(handle.get_label()), self.size))
            left += width + space["columnspacing"]
        return artists, words

    def _corner(
        self, wide: float, tall: float, free: float, page_width: float, page_height: float
    ) -> tuple[float, float]:
        """Left and top of the content; free: between it and `at`, or the edges of the page."""
        across, along = self.corner
        edge = {"left": 0.0, "center": page_width / 2.0, "right": page_width}[across]
        x, y = self.at or (edge, page_height if along == "top" else 0.0)
        left = {"left": x + free, "center": x - wide / 2.0, "right": x - free - wide}[across]
        return left, y - free if along == "top" else y + free + tall


def _split(handles: list[Line2D | Patch], columns: int) -> list[list[Line2D | Patch]]:
    """Columns as equal as can be, the longer ones first."""
    count = min(columns, len(handles))
    rows, longer = divmod(len(handles), count)
    out, at = [], 0
    for k in range(count):
        many = rows + (k < longer)
        out.append(handles[at : at + many])
        at += many
    return out


def _key(handle: Line2D | Patch, left: float, middle: float, space: Mapping[str, float]) -> Artist:
    length, height = space["handlelength"], space["handleheight"]
    if isinstance(handle, Patch):
        box = Rectangle((left, middle - height / 2.0), length, height)
        box.update_from(handle)
        box.set_zorder(LEGEND_ORDER)
        return box
    line = Line2D([], [])
    line.update_from(handle)
    alone = str(handle.get_linestyle()) == "None"
    marked = str(handle.get_marker()) != "None"
    if alone:
        line.set_data([left + length / 2.0], [middle])
    else:
        line.set_data([left, left + length / 2.0, left + length], [middle] * 3)
        line.set_markevery([1] if marked else None)
    line.set_clip_box(None)  # of the panel, where the handle is one of its lines
    line.set_zorder(LEGEND_ORDER)
    return line
