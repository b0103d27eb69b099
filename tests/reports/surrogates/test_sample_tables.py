"""Spans of the characteristics over a sample."""

from __future__ import annotations

import numpy as np

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.reports.render.json import table_records
from doe_kc.reports.render.terminal import table_lines
from doe_kc.reports.surrogates.sample_tables import span_table


def test_what_no_design_answers_is_left_out() -> None:
    values = np.full((3, len(CHARACTERISTICS)), np.nan)
    values[:, 1] = (1.0, 2.0, 6.0)
    values[0, 2] = 4.0
    table = span_table(values)
    ids = list(CHARACTERISTICS)
    assert [s.entry.id for s in table.rows] == ids[1:3]
    assert [(r["low"], r["mean"], r["high"]) for r in table_records(table)] == [(1, 3, 6), (4, 4, 4)]
    head, first, _ = table_lines(table)
    assert head.split() == ["characteristic", "lowest", "mean", "highest"]
    assert first.split()[:4] == [ids[1], "1", "3", "6"]


def test_no_design_no_span() -> None:
    assert len(table_lines(span_table(np.zeros((0, len(CHARACTERISTICS)))))) == 1
