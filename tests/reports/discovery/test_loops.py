"""Loops before and after in the verdict."""

from __future__ import annotations

import numpy as np

from doe_kc.reports.discovery.loops import LOOPS_DRAWN, VISIBLE_SDS, loop_figure, loop_pairs, loop_table
from doe_kc.reports.page.discovery import NO_LOOPS, verdict_section
from tests.discovery.cases import discovery


def test_friction_makes_loops_that_the_model_with_it_has_too() -> None:
    pairs = loop_pairs(discovery("two"))
    assert pairs and all(p.prominence > VISIBLE_SDS for p in pairs)
    for pair in pairs:
        assert abs(pair.before) < 1e-9 and pair.model == "with_effect"
        assert abs(pair.after - pair.measured) < 4.0 * pair.sd < abs(pair.measured)


def test_one_row_a_load_case_in_digits_of_the_noise() -> None:
    found = discovery("two")
    table = loop_table(loop_pairs(found))
    cases = [row.view.load_case for row in table.rows]
    assert len(cases) == len(set(cases))
    assert [c.head for c in table.columns][-2:] == ["As handed in", "With the effect"]


def test_a_loop_is_drawn_as_both_of_its_branches() -> None:
    pairs = loop_pairs(discovery("two"))
    page = loop_figure(pairs)
    assert len(page.panels) == min(len(pairs), LOOPS_DRAWN) and page.outside == []
    widest = max(pairs, key=lambda p: p.prominence)
    x, y = (np.asarray(v) for v in page.panels[0].lines[-1].get_data())
    half = widest.view.measured[widest.side]
    assert np.array_equal(y, np.concatenate([half[::-1], -half]))
    assert np.array_equal(x, np.concatenate([widest.view.input[::-1], widest.view.input]))


def test_a_car_without_friction_has_none() -> None:
    assert loop_pairs(discovery("none")) == []
    assert NO_LOOPS in str(verdict_section(discovery("none"), {}).html)
    assert "loops-table" in str(verdict_section(discovery("two"), {}).html)
