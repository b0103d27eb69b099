"""An outside solver on a page: its surrogate moves, it answers on release, and both are told apart."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.live.advice import best_step
from doe_kc.live.answer import LiveAnswer, solve_live
from doe_kc.live.background_work import BackgroundWork
from doe_kc.live.confirmation import learnt, stored_outcome
from doe_kc.live.documents import work_document
from doe_kc.live.keep import export_axle, export_page, export_table, read_state, save_state
from doe_kc.live.model import live_model
from doe_kc.live.outside_model import outside_model
from doe_kc.live.session import Session
from doe_kc.live.views import present_frame, shape_frame
from doe_kc.true_solver.own import AxleSolver
from doe_kc.workflow.measure import study_records
from tests.live.cases import say
from tests.live.outside import FAILS_ABOVE, car, outside_study

PATIENCE = 120.0
DESIGNS = 14


def move(live: Session, path: str, value: float, *, last: bool) -> None:
    update = say(live, kind="move", seq=live.seq + 1, path=path, value=value, last=last)
    live.solve(live.request(at_rest=update.at_rest))


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Session:
    study = outside_study(tmp_path_factory.mktemp("outside"), designs=DESIGNS)
    return Session(live_model(study, study_records(study)))


@pytest.fixture
def live(made: Session) -> Iterator[Session]:
    while made.can_undo:
        say(made, kind="undo")
    made.solve_now()
    yield made
    made.compilation.wait()


def error(live: Session, answer: LiveAnswer) -> float:
    """Largest error of a mean curve beside the car's own answer, share of its range."""
    truth = AxleSolver(car(live.model.study), live.model.windows).evaluate(dict(answer.values)).curves
    assert truth is not None
    shares = [
        np.abs(answer.curves.cases[c].mean[r] - curve).max() / np.ptp(curve)
        for c, case in truth.cases.items()
        for r, curve in case.mean.items()
        if np.ptp(curve) > 1e-6
    ]
    return float(max(shares))


def test_the_start_is_the_stored_answer_and_a_drag_the_surrogates(live: Session) -> None:
    assert live.nominal.true and live.present.true and error(live, live.nominal) < 1e-9
    start = live.values()["RIB.z"]
    move(live, "RIB.z", start + 0.7, last=False)
    assert not live.present.true and not present_frame(live, 1).text["true"]
    assert error(live, live.present) < 1e-3
    twin = live.present.base
    assert twin is not None and twin.curves is not None
    worse = np.abs(
        twin.curves.cases["lateral"].mean["camber"] - live.present.curves.cases["lateral"].mean["camber"]
    )
    assert worse.max() > 0.01  # the twin alone lacks the effect
    assert shape_frame(live.present, live.nominal.curves, "roll", 3, 1).drawn.size


def test_slopes_are_those_of_differences(live: Session) -> None:
    move(live, "LLF.z", live.values()["LLF.z"] + 0.5, last=False)
    slopes, model, base = live.slopes(), live.model, dict(live.present.values)
    for place, path in ((1, "RIB.z"), (3, "llr.Fx")):
        variable = model.space.variables[place]
        assert variable.path == path
        step = 1e-4 * (variable.upper - variable.lower)
        ends = [
            solve_live(model, base | {path: base[path] + s * step}, live.compilation) for s in (1.0, -1.0)
        ]
        assert isinstance(ends[0], LiveAnswer) and isinstance(ends[1], LiveAnswer)
        du = ends[0].point[place] - ends[1].point[place]
        exact = slopes.jacobian[:, place]
        np.testing.assert_allclose(
            exact, (ends[0].residual - ends[1].residual) / du, atol=1e-4 * np.abs(exact).max()
        )
        rows = (ends[0].characteristics - ends[1].characteristics) / du
        known = np.isfinite(rows)
        np.testing.assert_allclose(
            slopes.expansion.characteristics[known, place], rows[known], rtol=1e-3, atol=1e-3
        )


def test_an_answer_is_learnt_from(live: Session) -> None:
    """A surrogate without twin goes through a design that it has learnt."""
    assert live.model.outside is not None
    move(live, "ROB.z", live.values()["ROB.z"] + 1.0, last=False)
    values = dict(live.state.values)
    outcome = AxleSolver(car(live.model.study), live.model.windows).evaluate(dict(live.present.values))
    model = learnt(live.model, values, outcome)
    assert model.outside is not None and len(model.outside.designs) == len(live.model.outside.designs) + 1
    again = solve_live(model, values, live.compilation)
    assert isinstance(again, LiveAnswer) and error(live, again) < 1e-4


def test_advice_says_that_it_is_the_surrogates(live: Session) -> None:
    space = live.space
    advised = best_step(live.slopes(), space, (True,) * space.dimension, (), live.compilation)
    assert "by the surrogate" in advised.sentence and advised.adopt


def test_on_release_the_true_solver_answers_or_says_why_not(live: Session) -> None:
    """By its command, in a process of its own; the last design asked for wins."""
    jobs: list[Any] = []
    work = BackgroundWork(live, jobs.append, lambda: None, lambda: None)
    start = live.values()["RIB.z"]

    def settled() -> None:
        end = time.monotonic() + PATIENCE
        while work.confirming is not None:
            assert time.monotonic() < end
            while jobs:
                jobs.pop(0)()
            time.sleep(0.02)

    def release(value: float) -> None:
        move(live, "RIB.z", value, last=True)
        work.confirm(live.request())

    for k in range(3):  # the first runs, the second is replaced while it waits
        release(start + 0.5 + 0.1 * k)
        assert not live.present.true and work.confirming is not None
    settled()
    assert live.present.true and live.values()["RIB.z"] == start + 0.7
    assert error(live, live.present) < 1e-6
    assert stored_outcome(live.model, {"RIB.z": start + 0.6}) is None
    good = live.present
    release(start + FAILS_ABOVE + 0.5)
    settled()
    assert "the bridge fell down" in live.failure and live.present is good
    release(start)  # stored: not asked again
    assert work.confirming is None and live.present.true and not live.failure
    assert work_document(work)["outside"]["confirming"] is None
    work.close()


def test_bounds_do_not_leave_what_was_sampled(live: Session) -> None:
    variable = live.model.space.variables[0]
    with pytest.raises(InputError, match="the stored designs end at"):
        say(live, kind="bounds", path=variable.path, lower=variable.lower - 1.0, upper=variable.upper)
    assert say(
        live, kind="bounds", path=variable.path, lower=variable.lower + 1.0, upper=variable.upper
    ).state


def test_what_it_leaves_behind(live: Session) -> None:
    say(live, kind="snapshot")
    assert "saved" in save_state(live) and read_state(live).snapshots[0].answer.true
    move(live, "LLF.z", live.values()["LLF.z"] + 0.5, last=False)
    path = Path(export_axle(live).removeprefix("Axle written: "))
    assert "not confirmed by the outside solver" in path.read_text("utf-8").splitlines()[0]
    assert Path(export_table(live).removeprefix("Snapshot table written: ")).is_file()
    with pytest.raises(InputError, match="too many for an outside"):
        export_page(live)


@pytest.mark.parametrize(
    ("designs", "twin", "words"),
    [
        (5, False, "holds 5 designs.*at least 10.*doe-kc sample"),
        (0, True, "holds 0 designs.*at least 1 beside"),
    ],
)
def test_too_few_designs_are_said(tmp_path: Path, designs: int, twin: bool, words: str) -> None:
    study = outside_study(tmp_path, designs=designs, twin=twin)
    with pytest.raises(InputError, match=words):
        outside_model(study, study.space)


def test_without_a_twin_the_surrogate_is_of_the_designs_alone(tmp_path: Path) -> None:
    study = outside_study(tmp_path, designs=30, twin=False)
    live = Session(live_model(study, None))
    assert live.nominal.true and live.model.outside is not None
    assert "surrogate of 30 stored designs" in live.model.outside.sentence
    assert "twin" not in live.model.outside.sentence
    move(live, "RIB.z", live.values()["RIB.z"] + 0.7, last=False)
    assert live.present.base is None and error(live, live.present) < 0.05
    assert live.slopes().expansion.characteristics.shape[1] == study.space.dimension


def test_a_store_of_another_solver_is_refused(tmp_path: Path) -> None:
    study = outside_study(tmp_path, designs=12)
    (tmp_path / "bridge.py").write_text("print('another')", encoding="utf-8")
    with pytest.raises(InputError, match="another model or solver"):
        outside_model(study, study.space)
