"""In which format pictures are drawn."""

from __future__ import annotations

from typing import Literal

PictureFormat = Literal["png", "svg", "none"]
PNG: PictureFormat = "png"
"""The default: 150 dots an inch, opened by everything. svg: vectors, larger and slower. none: no pictures."""
