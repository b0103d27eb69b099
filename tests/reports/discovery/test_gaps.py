"""The picture of the gap: every load case and response is in it, however many there are."""

from __future__ import annotations

import pytest

from doe_kc.discovery.result import Gap
from doe_kc.load_cases import LOAD_CASES
from doe_kc.reports.discovery.gaps import gap_figure
from doe_kc.reports.discovery.tables import GapRow


@pytest.mark.parametrize("cases", range(1, len(LOAD_CASES) + 1))
def test_no_row_lies_below_its_column(cases: int) -> None:
    """With the seven load cases of a rear axle the second column is the longer one: six rows were missing."""
    gap = Gap(5.0, 2.0, 1.0, 0.99, 1.5)
    rows = [GapRow("", "", gap)]
    rows += [GapRow(case, r, gap) for case in list(LOAD_CASES)[:cases] for r in ("toe", "camber", "wc_x")]
    page = gap_figure(rows, "study")
    drawn = 0
    for panel in page.panels:
        deepest = max(panel.y.limits)
        places = panel.y.ticks(99).places
        assert all(0.0 < place < deepest for place in places)
        drawn += len(places)
    assert drawn == len(rows) + 1 + cases
