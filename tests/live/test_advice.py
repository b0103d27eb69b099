"""Advice: that the true model is better after it, that locks, bounds and holds are kept."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import InputError
from doe_kc.live.advice import influence
from doe_kc.live.messages import read_message
from doe_kc.live.session import Session
from tests.live.cases import session


@pytest.fixture(scope="module")
def live() -> Session:
    return session()


def test_the_best_step_brings_the_true_model_nearer_within_the_bounds(live: Session) -> None:
    advised = live.advise("best_step")
    for variable in live.space.variables:
        assert variable.lower <= advised.adopt[variable.path] <= variable.upper
    live.adopt(advised.adopt)
    live.solve_now()
    assert live.present.gap < 0.5 * live.nominal.gap
    live.handle(read_message('{"kind": "undo"}'))
    live.solve_now()
    assert live.present.gap == pytest.approx(live.nominal.gap)


def test_locked_sliders_and_held_characteristics_stay(live: Session) -> None:
    free = ["RIB.z", "ROB.z", "LLF.z", "LLR.z", "llr.Fy", "llf.Fy"]
    live.handle(read_message('{"kind": "lock", "on": true}'))
    live.handle(read_message(json.dumps({"kind": "lock", "paths": free, "on": False})))
    held = "vertical.camber_change"
    assert held in CHARACTERISTICS
    live.handle(read_message(json.dumps({"kind": "hold", "characteristic": held, "on": True})))
    advised = live.advise("best_step")
    assert set(advised.adopt) == set(free)
    live.adopt(advised.adopt)
    live.solve_now()
    row = list(CHARACTERISTICS).index(held)
    before, after = live.nominal.characteristics[row], live.present.characteristics[row]
    assert after == pytest.approx(before, rel=2e-3)
    assert live.present.gap < live.nominal.gap
    live.handle(read_message('{"kind": "undo"}'))
    live.solve_now()
    live.handle(read_message('{"kind": "lock", "on": true}'))
    with pytest.raises(InputError, match="locked"):
        live.advise("best_step")
    live.handle(read_message('{"kind": "lock", "on": false}'))


def test_the_first_helper_is_the_best_single_slider(live: Session) -> None:
    helpers = live.advise("helpers")
    assert len(helpers.rows) == 3
    gains = np.abs(influence(live.slopes(), live.space)[0])
    paths = live.space.paths
    first = paths[int(np.argmax(gains))]
    assert first == helpers.rows[0].path


def test_a_slider_that_the_records_do_not_see_is_listed(live: Session) -> None:
    """Its column of the Jacobian is zero: nothing of its uncertainty is taken away."""
    slopes = live.slopes()
    blind = slopes.jacobian.copy()
    blind[:, 7] = 0.0
    from doe_kc.live.advice import not_visible

    told = not_visible(replace(slopes, jacobian=blind), live.space, [True] * len(live.space.paths))
    listed = {row.path: row.note for row in told.rows}
    assert "leave 100 %" in listed[live.space.paths[7]]


def test_influence_of_curves_is_that_of_the_true_model(live: Session) -> None:
    """RMS change of a curve by finite differences."""
    table, path = influence(live.slopes(), live.space), "RIB.z"
    column = live.space.paths.index(path)
    start, step = live.values()[path], 0.02
    toe = []
    for sign in (1.0, -1.0):
        live.handle(
            read_message(json.dumps({"kind": "move", "seq": 1, "path": path, "value": start + sign * step}))
        )
        live.solve_now()
        toe.append(live.present.curves.cases["vertical"].mean["toe"][0])
    live.handle(read_message('{"kind": "reset"}'))
    live.solve_now()
    wanted = np.sqrt(np.mean(((toe[0] - toe[1]) / (2 * step)) ** 2))
    row = 1 + len(CHARACTERISTICS)  # vertical, toe: the first curve
    assert table[row, column] == pytest.approx(wanted, rel=1e-3)
