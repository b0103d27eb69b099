"""The first-order model of the page that moves without a server, against the true model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.live.answer import LiveAnswer, solve_live
from doe_kc.live.first_order import MOST_SLIDERS, FirstOrder, checked_range, first_order
from doe_kc.live.frames import drawn_curves
from doe_kc.live.session import Session
from tests.live.cases import session


@pytest.fixture(scope="module")
def live() -> Session:
    return session()


@pytest.fixture(scope="module")
def model(live: Session) -> FirstOrder:
    return first_order(live.slopes(), live.space)


def solved(live: Session, values: dict[str, float]) -> LiveAnswer:
    answer = solve_live(live.model, values, live.compilation)
    assert isinstance(answer, LiveAnswer)
    return answer


def test_its_error_is_of_second_order(live: Session, model: FirstOrder) -> None:
    """A tenth of the move leaves a hundredth of the error."""
    assert len(model.paths) == MOST_SLIDERS
    start = live.values()
    chosen = [p for p in model.paths if p.endswith((".z", ".x"))][:3]
    errors = []
    for size in (1.0, 0.1):
        values = {p: start[p] + size for p in chosen}
        answer = solved(live, values)
        curves, characteristics, gap = model.predict(values)
        errors.append(np.abs(curves - drawn_curves(answer.curves, model.answer.curves)).max())
        change = answer.characteristics - model.characteristics
        wanted = characteristics - model.characteristics
        np.testing.assert_allclose(wanted, change, atol=0.1 * np.abs(change).max() * size + 1e-9)
        assert gap == pytest.approx(answer.gap, rel=0.02)
    assert errors[1] < 0.02 * errors[0]


def test_the_range_is_checked_against_the_true_model(live: Session, model: FirstOrder) -> None:
    checked = checked_range(model, live.compilation, seed=1)
    assert checked.designs + checked.unsolved == 2 * MOST_SLIDERS + 12
    assert 0.0 < checked.curve_error < 1.0 and 0.0 < checked.joint_error < 1.0


def test_an_error_is_found_where_it_was_made(live: Session, model: FirstOrder) -> None:
    """Slopes of one curve put wrong: the check names it."""
    wrong = model.slopes.copy()
    n = live.present.curves.cases["vertical"].input.size
    wrong[: 2 * n] *= 3.0  # vertical, toe: the first curve
    checked = checked_range(replace(model, slopes=wrong), live.compilation, seed=1)
    assert checked.where == "vertical motion, toe" and checked.curve_error > 0.3
