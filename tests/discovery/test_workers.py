"""Where discoveries compute: workers' results are those of this process, and stored ones those computed."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.campaign.executors import processes
from doe_kc.discovery import result_cache
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.result_cache import Arrays, ResultCache
from doe_kc.discovery.screening.scan import scanned_places
from doe_kc.discovery.screening.screen import effort
from doe_kc.discovery.search.baseline import tune
from doe_kc.discovery.thresholds import FREE_SHAPE_LOSS
from doe_kc.discovery.workers import TASKS_AHEAD, DiscoveryWorkers
from doe_kc.solver.result import Failure, NotConverged
from tests.discovery.cases import library, model


@pytest.fixture(scope="module")
def tuned() -> Fit:
    return tune(model("named"))


def start(tuned: Fit) -> tuple[EffectModel, np.ndarray]:
    (hub,) = library("hub_compliance")
    return tuned.model.extended(hub), np.concatenate([tuned.z, [0.5, 0.5]])


def test_a_fit_of_a_worker_is_of_the_very_model_and_errors_of_its_start(tuned: Fit) -> None:
    extended, z = start(tuned)
    with processes(2) as executor:
        (there,) = DiscoveryWorkers(executor, workers=2).fits([FitStart(extended, z, tuned)], "")
    (here,) = DiscoveryWorkers().fits([FitStart(extended, z, tuned)], "")
    assert there is not None and here is not None
    assert there.model is extended and there.model.likelihood is tuned.model.likelihood
    assert np.array_equal(there.z, here.z) and np.array_equal(there.jacobian.own, here.jacobian.own)


def test_residuals_are_those_of_each_model_at_its_point(tuned: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    extended, z = start(tuned)
    points = [(tuned.model, tuned.z), (extended, z), (extended, z + 0.1)]
    steps: list[tuple[str, int, int]] = []
    with processes(2) as executor:
        workers = DiscoveryWorkers(executor, watch=lambda *step: steps.append(step), workers=2)
        there = workers.residuals(points)
    for residual, (model_, at) in zip(there, points, strict=True):
        assert residual is not None
        np.testing.assert_array_equal(residual, model_.residual(at))
    assert [left for _, _, left in steps] == [2, 1, 0]

    def locked(_model: EffectModel, at: np.ndarray) -> np.ndarray:
        if at.size == z.size:
            raise NotConverged(Failure("steer", "load", 1, 1.0, "deg", 0.0, "", "it locks"))
        return at

    monkeypatch.setattr(EffectModel, "residual", locked)
    alone = DiscoveryWorkers().residuals(points)
    assert alone[0] is tuned.z and alone[1:] == [None, None]


def test_a_stored_fit_is_the_computed_one(tuned: Fit, tmp_path: Path) -> None:
    begun, steps = [FitStart(*start(tuned), tuned)], []
    fits = []
    for _ in range(2):
        with ResultCache(tmp_path / "discovery.sqlite") as cache:
            workers = DiscoveryWorkers(cache=cache, watch=lambda *step: steps.append(step))
            fits += workers.fits(begun, "refitting")
    computed, stored = fits
    for name in ("z", "residual", "cost", "evaluations", "converged"):
        assert np.array_equal(getattr(computed, name), getattr(stored, name)), name
    assert np.array_equal(computed.jacobian.own, stored.jacobian.own)
    assert stored.evidence == pytest.approx(computed.evidence, rel=1e-12)
    assert steps == [("refitting", 1, 0), ("refitting", 1, 0)]


def test_what_the_model_says_is_not_stored_and_comes_back_in_its_place(tuned: Fit) -> None:
    widths: list[int] = []

    class Widths(ResultCache):
        def put(self, key: str, arrays: Arrays) -> None:
            widths.append(arrays["jacobian"].shape[1])
            super().put(key, arrays)

    workers = DiscoveryWorkers(cache=Widths(None))
    model, z = start(tuned)
    computed, stored = (workers.fits([FitStart(model, z, tuned)], "")[0] for _ in range(2))
    assert computed is not None and stored is not None and model.nuisances is not None
    assert widths == [z.size - model.nuisances.count]
    assert np.array_equal(stored.jacobian.dense, computed.jacobian.dense)


def test_results_of_another_format_are_not_taken_up(
    tuned: Fit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hypotheses = library("hub_compliance")
    stored: list[int] = []
    for tag in ("one", "one", "two"):
        monkeypatch.setattr(result_cache, "FORMAT", tag)
        with ResultCache(tmp_path / "discovery.sqlite") as cache:
            put = cache.put
            monkeypatch.setattr(cache, "put", lambda *a, put=put, tag=tag: (stored.append(tag), put(*a)))
            DiscoveryWorkers(cache=cache).screenings(tuned, hypotheses)
    assert stored == ["one", "two"]


def test_the_longest_screenings_begin_first(tuned: Fit) -> None:
    begun: list[str] = []

    class Order(ResultCache):
        def put(self, key: str, arrays: object) -> None:
            begun.append(key)

    hypotheses = library("rig_channel_gain", "steering_friction")
    efforts = [effort(h) for h in hypotheses]
    assert efforts[-1] > max(efforts[:-1])
    workers = DiscoveryWorkers(cache=Order(None))
    found = workers.screenings(tuned, hypotheses)
    assert [s.hypothesis for s in found] == hypotheses
    alone = Order(None)
    first = begun[0]
    begun.clear()
    DiscoveryWorkers(cache=alone).screenings(tuned, hypotheses[-1:])
    assert begun == [first]


def test_the_longest_fits_begin_first(tuned: Fit) -> None:
    """Those of most unknowns; they are given in the order that they were asked for in."""
    ended: list[int] = []

    class Order(ResultCache):
        def put(self, key: str, arrays: Arrays) -> None:
            ended.append(arrays["z"].size)

    larger = FitStart(*start(tuned), tuned)
    begun = [FitStart(tuned.model, tuned.z, tuned), larger]
    fits = DiscoveryWorkers(cache=Order(None)).fits(begun, "")
    assert [fit.model for fit in fits if fit is not None] == [tuned.model, larger.model]
    assert ended == [larger.z.size, tuned.z.size]


def test_fits_are_kept_without_derivatives_on_request_and_no_more_are_begun_than_workers_do(
    tuned: Fit,
) -> None:
    extended, z = start(tuned)
    asked: list[float] = []

    def starts() -> Iterator[tuple[float]]:
        for i in range(9):
            asked.append(float(i))
            yield (float(i),)

    (short,) = DiscoveryWorkers().fits([FitStart(extended, z, tuned)], "", derivatives=lambda _: False)
    assert short is not None and not short.jacobian.own.size
    with ThreadPoolExecutor(1) as executor:
        done = DiscoveryWorkers(executor)._run(abs, starts())
        first = next(done)
        assert first == (0, 0.0) and len(asked) <= TASKS_AHEAD + 1
        assert dict([first, *done]) == {i: float(i) for i in range(9)}


@pytest.mark.parametrize("count", [1, 2])
def test_a_first_fit_that_will_do_is_the_only_one(tuned: Fit, count: int, tmp_path: Path) -> None:
    """Nothing else is computed."""
    extended, z = start(tuned)
    starts = [FitStart(extended, np.append(z[:-2], [a, a]), tuned) for a in (0.5, 0.7, 0.3, 0.9)]
    stored: list[str] = []

    class Noted(ResultCache):
        def put(self, key: str, arrays: Arrays) -> None:
            stored.append(key)
            super().put(key, arrays)

    with processes(count) as executor, Noted(tmp_path / "discovery.sqlite") as cache:
        workers = DiscoveryWorkers(executor, cache, workers=count)
        (first,) = workers.fits(starts, "", enough=lambda refit: refit is not None)
        assert len(stored) == 1
        assert len(workers.fits(starts, "", enough=lambda refit: refit is None)) == len(starts)
        assert len(set(stored)) == len(starts)
        (again,) = workers.fits(starts, "", enough=lambda refit: refit is not None)
    assert first is not None and again is not None and np.array_equal(first.z, again.z)


def test_the_other_starts_are_given_up_where_they_promise_less_than_the_first(tuned: Fit) -> None:
    """One that is not far above it is not."""
    extended, z = start(tuned)
    near, far = (
        FitStart(extended, np.append(z[:-2], [a, a]), tuned, ceiling)
        for a, ceiling in ((0.5, np.inf), (0.7, 7.0))
    )
    given: list[float] = []

    class Noted(DiscoveryWorkers):
        def _run(self, task, arguments):  # type: ignore[no-untyped-def]
            tasks = list(arguments)
            given.extend(ceiling for *_, ceiling, _ in tasks)
            return super()._run(task, tasks)

    first, _, last = Noted().fits([near, near, far], "", enough=lambda refit: False)
    assert first is not None and last is not None and not last.converged
    assert given == [np.inf, first.cost + 2.0 * FREE_SHAPE_LOSS, 7.0]


def test_a_fit_that_is_alone_has_every_core(tuned: Fit) -> None:
    """Beside others one has its own only."""
    extended, z = start(tuned)
    begun = FitStart(extended, z, tuned)
    given: list[int] = []

    class Noted(DiscoveryWorkers):
        def _run(self, task, arguments):  # type: ignore[no-untyped-def]
            tasks = list(arguments)
            given.extend(threads for *_, threads in tasks)
            return super()._run(task, tasks)

    (alone,) = Noted(workers=2).fits([begun], "")
    beside = Noted(workers=2).fits([begun, begun], "")
    assert given == [2, 1, 1]
    assert alone is not None
    for other in beside:
        assert other is not None
        np.testing.assert_array_equal(other.z, alone.z)
        np.testing.assert_array_equal(other.jacobian.own, alone.jacobian.own)


def test_deferred_tasks_begin_beside_a_single_task_alone(tuned: Fit) -> None:
    """Beside several they would hold up what comes next; what has not begun does when it is asked for."""
    for values, begun in (([1.0], 1), ([1.0, 2.0], 0)):
        with ThreadPoolExecutor(2) as executor:
            workers = DiscoveryWorkers(executor, workers=2)
            workers.defer(tuned)
            deferred = workers._of_tuned(tuned)
            given = [(-v,) for v in values]
            assert sorted(result for _, result in workers._run(abs, given)) == values
            assert sum(not task.waits for task in deferred.tasks) >= begun
            if not begun:
                assert all(task.waits for task in deferred.tasks)
            scanned = workers.scan(tuned)()
            predictions = workers.held_out(tuned, tuned, tuned)()
        assert [p.load_case for p in predictions] == list(tuned.model.cases)
        assert all(p.tuned == p.with_effect == p.law_granted for p in predictions)
        assert scanned is not None and scanned[0] == scanned_places(tuned)[0]


def test_what_is_known_of_another_re_tuned_axle_is_not_taken(tuned: Fit) -> None:
    workers = DiscoveryWorkers()
    workers.defer(replace(tuned, z=tuned.z.copy()))
    assert workers._of_tuned(tuned).tuned is tuned
