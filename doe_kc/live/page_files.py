"""The files of the page, as they lie in the package."""

from __future__ import annotations

from importlib.resources import files

SERVED = {
    "live.css": "text/css",
    "live.js": "text/javascript",
    "frames.js": "text/javascript",
    "charts.js": "text/javascript",
    "axle.js": "text/javascript",
    "uPlot.iife.min.js": "text/javascript",
    "uPlot.min.css": "text/css",
}
"""Name -> type; nothing else is served."""


def asset(name: str) -> str:
    """Text of a file of the page."""
    return (files("doe_kc.live") / "assets" / name).read_text(encoding="utf-8")
