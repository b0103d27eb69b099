"""One axis of a panel: its limits, its scale, its ticks and what is written at them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from matplotlib.scale import LogTransform, SymmetricalLogTransform
from matplotlib.ticker import (
    Formatter,
    Locator,
    LogFormatterSciNotation,
    LogLocator,
    MaxNLocator,
    ScalarFormatter,
)
from matplotlib.transforms import IdentityTransform, Transform
from numpy.typing import ArrayLike

from doe_kc.ground.typing import FloatArray

MARGIN = 0.05
"""Share of the data's range that stays free at either end (Matplotlib's own)."""
STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


@lru_cache(maxsize=32)
def ticks(count: int) -> MaxNLocator:
    """At most `count` intervals between round numbers; the same object every time."""
    return MaxNLocator(count, steps=STEPS)


@lru_cache(maxsize=1)
def _usual_formatter() -> ScalarFormatter:
    return ScalarFormatter()


@dataclass(frozen=True)
class Ticks:
    """places: values within the limits. words: at each. minor: places of short marks. remark: the factor or
    offset that was taken out of large and close numbers. formula: whether the words are formulas."""

    places: FloatArray
    words: tuple[str, ...]
    bold: tuple[bool, ...]
    minor: FloatArray
    remark: str = ""
    formula: bool = False


class PanelAxis:
    """Limits follow the data, with a margin, until they are set; the last one set holds."""

    def __init__(self) -> None:
        self._low, self._high = np.inf, -np.inf
        self._limits: tuple[float, float] | None = None
        self._known_limits: tuple[float, float] | None = None
        self._known_ticks: dict[tuple[float, float, int], Ticks] = {}
        self._fixed: Ticks | None = None
        self._locator: Locator | None = None
        self._formatter: Formatter | None = None
        self.scale: Transform = IdentityTransform()
        self.logarithmic = False

    def include(self, values: ArrayLike) -> None:
        """Let the limits enclose finite `values`, on a logarithmic axis the positive ones."""
        data = np.asarray(values, dtype=float)
        data = data[np.isfinite(data) & (data > 0.0)] if self.logarithmic else data[np.isfinite(data)]
        if data.size:
            self._known_limits = None
            self._low = min(self._low, float(data.min()))
            self._high = max(self._high, float(data.max()))

    def set_limits(self, start: float, end: float) -> None:
        """Left and right, or bottom and top; start above end for an inverted axis."""
        self._limits = (float(start), float(end))

    def set_logarithmic(self) -> None:
        """Base 10."""
        self.scale, self._known_limits = LogTransform(10.0), None
        self.logarithmic = True

    def set_symmetrical_logarithmic(self, linear: float) -> None:
        """Base 10 on either side, linear between -linear and linear."""
        self.scale, self._known_limits = SymmetricalLogTransform(10.0, linear, 1.0), None

    def set_ticks(self, places: ArrayLike, words: Sequence[str], bold: Sequence[bool] = ()) -> None:
        """Fixed ones; bold: which of the words are."""
        at = np.asarray(places, dtype=float)
        self._fixed = Ticks(at, tuple(words), tuple(bold) or (False,) * at.size, np.zeros(0))

    def set_locator(self, locator: Locator, formatter: Formatter | None = None) -> None:
        """Where ticks are, and what is written there: Matplotlib's ScalarFormatter unless told."""
        self._locator, self._formatter = locator, formatter
        self._known_ticks.clear()

    @property
    def limits(self) -> tuple[float, float]:
        """Start and end of the axis."""
        if self._limits is not None:
            return self._limits
        if self._known_limits is None:
            self._known_limits = self._data_limits()
        return self._known_limits

    def _data_limits(self) -> tuple[float, float]:
        if self._low > self._high:
            return (1.0, 10.0) if self.logarithmic else (0.0, 1.0)
        low, high = self._low, self._high
        if not self.logarithmic:
            low, high = ticks(9).nonsingular(low, high)  # wider where all values are the same
        elif low == high:
            low, high = low / 10.0, high * 10.0
        start, end = self._scaled(np.array([low, high]))
        free = MARGIN * (end - start)
        inverse = self.scale.inverted().transform(np.array([[start - free], [end + free]]))[:, 0]
        return float(inverse[0]), float(inverse[1])

    def shares(self, values: ArrayLike) -> FloatArray:
        """Places along the axis, 0 at its start and 1 at its end."""
        start, end = self.scaled_limits
        out: FloatArray = (self._scaled(np.asarray(values, dtype=float)) - start) / (end - start)
        return out

    @property
    def scaled_limits(self) -> tuple[float, float]:
        """Limits after the scale."""
        start, end = self._scaled(np.array(self.limits))
        return float(start), float(end)

    def _scaled(self, values: FloatArray) -> FloatArray:
        if isinstance(self.scale, IdentityTransform):
            return values
        return np.asarray(self.scale.transform(values.reshape(-1, 1))[:, 0], dtype=float)

    def ticks(self, most: int) -> Ticks:
        """Those within the limits; most: intervals, where no locator was set."""
        if self._fixed is not None:
            return _inside(self._fixed, self.limits)
        low, high = sorted(self.limits)
        if (low, high, most) not in self._known_ticks:  # panels of a sheet share their axes
            self._known_ticks[low, high, most] = self._located(low, high, most)
        return self._known_ticks[low, high, most]

    def _located(self, low: float, high: float, most: int) -> Ticks:
        if self.logarithmic and self._locator is None:
            return self._decades(low, high)
        locator = self._locator or ticks(min(max(most, 1), 9))
        places = np.asarray(locator.tick_values(low, high), dtype=float)
        formatter = self._formatter or _usual_formatter()
        words = _formatted(formatter, places, (low, high))
        major = Ticks(places, words, (False,) * places.size, np.zeros(0), formatter.get_offset())
        return _inside(major, self.limits)

    def _decades(self, low: float, high: float) -> Ticks:
        places = np.asarray(LogLocator(10.0).tick_values(low, high), dtype=float)
        minor = np.asarray(LogLocator(10.0, subs=tuple(range(2, 10))).tick_values(low, high), dtype=float)
        words = _formatted(LogFormatterSciNotation(10.0), places, (low, high))
        return _inside(Ticks(places, words, (False,) * places.size, minor, formula=True), self.limits)


def _formatted(formatter: Formatter, places: FloatArray, limits: tuple[float, float]) -> tuple[str, ...]:
    formatter.create_dummy_axis()
    formatter.axis.set_view_interval(*limits)  # type: ignore[union-attr]
    formatter.axis.set_data_interval(*limits)  # type: ignore[union-attr]
    return tuple(formatter.format_ticks(list(places)))


def _inside(all_ticks: Ticks, limits: tuple[float, float]) -> Ticks:
    low, high = sorted(limits)
    slack = 1e-10 * (high - low)
    inside = (all_ticks.places >= low - slack) & (all_ticks.places <= high + slack)
    short = (all_ticks.minor >= low) & (all_ticks.minor <= high)
    kept = np.flatnonzero(inside)
    return Ticks(
        all_ticks.places[kept],
        tuple(all_ticks.words[i] for i in kept),
        tuple(all_ticks.bold[i] for i in kept),
        all_ticks.minor[short],
        all_ticks.remark,
        all_ticks.formula,
    )
