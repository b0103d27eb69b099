"""Grid, frame, tick marks, numbers and names of a panel, as segments and words in points of the page."""

from __future__ import annotations

from dataclasses import dataclass, field

from doe_kc.ground.typing import FloatArray
from doe_kc.reports.drawing.panel import TITLE_PAD, Panel
from doe_kc.reports.drawing.panel_axis import Ticks
from doe_kc.reports.drawing.words import Across, Along, Word, extent

TICK, MINOR, PAD = 3.5, 2.0, 3.5
"""Points: lengths of tick marks, and from their end to the number (Matplotlib's own)."""
ROOM = {"x": 30.0, "y": 20.0}
"""Points of an axis for each of its intervals where nobody says how many there are."""
LABEL_PAD = 4.0
"""Points between numbers and the axis label (Matplotlib's own)."""

Segment = tuple[tuple[float, float], tuple[float, float]]


@dataclass
class Frame:
    """What is drawn of all panels of a sheet, one collection each."""

    grid: list[Segment] = field(default_factory=list)
    lines: list[Segment] = field(default_factory=list)
    minor: list[Segment] = field(default_factory=list)
    words: list[Word] = field(default_factory=list)

    def add(self, panel: Panel) -> None:
        """The limits of the panel are final."""
        box = panel.box
        x = panel.x.ticks(int(box.width / ROOM["x"]))
        y = panel.y.ticks(int(box.height / ROOM["y"]))
        across = box.left + box.width * panel.x.shares(x.places)
        along = box.bottom + box.height * panel.y.shares(y.places)
        if panel.spines["bottom"]:
            self.lines.append(((box.left, box.bottom), (box.right, box.bottom)))
        if panel.spines["left"]:
            self.lines.append(((box.left, box.bottom), (box.left, box.top)))
        if panel.grid["x"]:
            self.grid += [((t, box.bottom), (t, box.top)) for t in across]
        if panel.grid["y"]:
            self.grid += [((box.left, t), (box.right, t)) for t in along]
        below = self._x(panel, x, across)
        left = self._y(panel, y, along)
        name = panel.x_label
        middle = box.left + box.width / 2.0
        self._write(Word(middle, box.bottom - below - LABEL_PAD, name.text, name.size, "center", "top"))
        name, middle = panel.y_label, box.bottom + box.height / 2.0
        start = box.right + left + LABEL_PAD if panel.right else box.left - left - LABEL_PAD
        beside: Along = "top" if panel.right else "bottom"
        self._write(Word(start, middle, name.text, name.size, "center", beside, angle=90.0))
        title = panel.title
        at = {"left": box.left, "center": box.left + box.width / 2.0, "right": box.right}[title.across]
        self._write(
            Word(
                at, box.top + TITLE_PAD, title.text, title.size, title.across, "baseline", weight=title.weight
            )
        )

    def _write(self, word: Word) -> None:
        if word.text:
            self.words.append(word)

    def _x(self, panel: Panel, ticks: Ticks, across: FloatArray) -> float:
        """Points from the panel's lower edge to the end of the numbers."""
        box, size = panel.box, panel.number_size["x"]
        below = 0.0
        if panel.marks["x"]:
            below = TICK
            self.lines += [((t, box.bottom), (t, box.bottom - TICK)) for t in across]
            small = box.left + box.width * panel.x.shares(ticks.minor)
            self.minor += [((t, box.bottom), (t, box.bottom - MINOR)) for t in small]
        if not panel.numbers["x"]:
            return below
        start = box.bottom - below - PAD
        angle = panel.number_angle["x"]
        along: Along = "center" if angle == 90.0 else "top"
        words = [
            Word(
                t,
                start,
                word,
                size,
                "right" if angle else "center",
                along,
                weight=_weight(bold),
                angle=angle,
                formula=ticks.formula,
            )
            for t, word, bold in zip(across, ticks.words, ticks.bold, strict=True)
        ]
        self.words += words
        lowest = min((extent(w)[1] for w in words if w.text), default=start)
        if ticks.remark:
            self._write(Word(box.right, lowest, ticks.remark, size, "right", "top"))
            lowest -= 1.2 * size
        return box.bottom - lowest

    def _y(self, panel: Panel, ticks: Ticks, along: FloatArray) -> float:
        """Points from the panel's left edge, or right one, to the end of the numbers."""
        box, size = panel.box, panel.number_size["y"]
        edge, sign = (box.right, 1.0) if panel.right else (box.left, -1.0)
        beside = 0.0
        if panel.marks["y"]:
            beside = TICK
            self.lines += [((edge, t), (edge + sign * TICK, t)) for t in along]
            small = box.bottom + box.height * panel.y.shares(ticks.minor)
            self.minor += [((edge, t), (edge + sign * MINOR, t)) for t in small]
        if not panel.numbers["y"]:
            return beside
        start = edge + sign * (beside + PAD)
        across: Across = "left" if panel.right else "right"
        words = [
            Word(start, t, word, size, across, "center", weight=_weight(bold), formula=ticks.formula)
            for t, word, bold in zip(along, ticks.words, ticks.bold, strict=True)
        ]
        self.words += words
        self._write(Word(box.left, box.top + 2.0, ticks.remark, size, "left", "bottom"))
        sizes = [extent(w) for w in words if w.text]
        return beside + PAD + max((right - left for left, _, right, _ in sizes), default=0.0)


def _weight(bold: bool) -> str:
    return "bold" if bold else "normal"
