"""What every result of the Python API can do: a frame, a short text, a notebook's view."""

from __future__ import annotations

from abc import ABC, abstractmethod
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

HTML_ROWS, HTML_COLUMNS = 20, 12
"""Of a frame in a notebook; pandas leaves out the middle of larger ones."""


class FrameResult(ABC):
    """A result whose main table is `to_frame()`; its `repr` is `lines`, whatever its size."""

    @property
    @abstractmethod
    def lines(self) -> list[str]:
        """What it says, in a few lines."""

    @abstractmethod
    def to_frame(self) -> pd.DataFrame:
        """The main table."""

    def __repr__(self) -> str:
        first, *more = self.lines
        return "\n".join([f"{type(self).__name__}: {first}", *(f"  {line}" for line in more)])

    def _repr_html_(self) -> str:
        """For notebooks: the same lines above the main table."""
        first, *more = map(escape, self.lines)
        head = "<br>".join([f"<b>{type(self).__name__}</b>: {first}", *more])
        table = self.to_frame().to_html(max_rows=HTML_ROWS, max_cols=HTML_COLUMNS)
        return f"<div><p>{head}</p>{table}</div>"
