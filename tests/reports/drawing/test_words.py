"""Lines of text as FreeType draws them in one call beside Matplotlib's own drawing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.font_manager import FontProperties

from doe_kc.reports.drawing.style import DPI
from doe_kc.reports.drawing.words import line_image

EDGE = 40


@pytest.mark.parametrize("size", [6.5, 8.0, 11.0])
@pytest.mark.parametrize(
    "line",
    ["\N{MINUS SIGN}0.25", "toe [deg] left AVWA", "gy|\N{LATIN CAPITAL LETTER A WITH DIAERESIS}j", "1"],
)
def test_a_line_lies_where_matplotlib_draws_it(line: str, size: float) -> None:
    image = line_image(line, size, "normal", "sans-serif", False)
    wide, tall = image.coverage.shape[1] + 2 * EDGE, image.coverage.shape[0] + 2 * EDGE
    own = np.zeros((tall, wide))
    bottom = tall - EDGE + image.below
    rows = slice(bottom - image.coverage.shape[0], bottom)
    own[rows, EDGE - image.left : EDGE - image.left + image.coverage.shape[1]] = image.coverage
    peer = RendererAgg(wide, tall, DPI)
    peer.draw_text(peer.new_gc(), EDGE, tall - EDGE, line, FontProperties(size=size), 0.0)
    drawn = np.asarray(peer.buffer_rgba())[:, :, 3].astype(float)
    shifts = {
        (dx, dy): float(np.abs(np.roll(own, (dy, dx), (0, 1)) - drawn).sum())
        for dx in (-1, 0, 1)
        for dy in (-2, -1, 0, 1, 2)
    }
    across, along = min(shifts, key=shifts.__getitem__)
    assert abs(across) <= 1 and along == 0  # hinting moves the first letter by less than a pixel
    assert math.isclose(own.sum(), drawn.sum(), rel_tol=0.1)
