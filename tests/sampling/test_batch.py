"""Many designs: order, failures as values, one process or two, a worker that is lost."""

from __future__ import annotations

import os
import signal
from dataclasses import replace

import numpy as np
import pytest

from doe_kc.axle import Axle
from doe_kc.characteristics import CHARACTERISTICS, reduce_all
from doe_kc.errors import InputError, RunError
from doe_kc.sampling import batch
from doe_kc.sampling.batch import Evaluation, available_cores, evaluate, evaluate_all
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from tests.reference import nominal

IMPOSSIBLE = {"LWB.z": 2000.0}


@pytest.fixture(autouse=True)
def interpreted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DOE_KC_COMPILE", "0")


def axle() -> Axle:
    """Two load cases only."""
    cases = nominal().load_cases
    return replace(nominal(), load_cases={i: cases[i] for i in ("vertical", "brake")})


def moved(count: int) -> list[dict[str, float]]:
    return [{"LLF.z": 208.0 + i} for i in range(count)]


def values(evaluations: list[Evaluation]) -> np.ndarray:
    return np.array([e.characteristics for e in evaluations])


def test_one_design_is_the_solver_and_the_reduction() -> None:
    found = evaluate(axle(), {})
    direct = reduce_all(curve_set(solve(axle(), compiled=False)))
    assert found.reason == ""
    np.testing.assert_allclose(found.characteristics, list(direct.values()), rtol=1e-9)
    assert list(direct) == list(CHARACTERISTICS)


def test_order_is_kept_and_two_workers_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batch, "CHUNK", 2)
    designs = moved(7)
    told: list[int] = []
    alone = evaluate_all(axle(), designs, workers=1)
    shared = evaluate_all(axle(), designs, workers=2, progress=told.append)
    np.testing.assert_array_equal(values(alone), values(shared))
    assert told == [2, 2, 2, 1]
    steer = values(alone)[:, list(CHARACTERISTICS).index("vertical.bump_steer")]
    assert (np.diff(steer) < 0).all()


def test_progress_counts_every_design() -> None:
    told: list[int] = []
    evaluate_all(axle(), moved(2), workers=1, progress=told.append)
    assert told == [1, 1]
    assert evaluate_all(axle(), [], workers=2) == []


@pytest.mark.parametrize("workers", [1, 2])
def test_a_failure_is_a_value_with_its_reason(monkeypatch: pytest.MonkeyPatch, workers: int) -> None:
    monkeypatch.setattr(batch, "CHUNK", 1)
    good, bad, after = evaluate_all(axle(), [{}, IMPOSSIBLE, {}], workers=workers)
    assert np.isnan(bad.characteristics).all() and len(bad.characteristics) == len(CHARACTERISTICS)
    assert "load case" in bad.reason and "worst residual" in bad.reason
    assert good.reason == after.reason == ""
    np.testing.assert_array_equal(good.characteristics, after.characteristics)


@pytest.mark.parametrize("workers", [1, 2])
def test_a_path_that_is_not_there_is_bad_input(monkeypatch: pytest.MonkeyPatch, workers: int) -> None:
    monkeypatch.setattr(batch, "CHUNK", 1)
    with pytest.raises(InputError, match="unknown parameter"):
        evaluate_all(axle(), [{}, {"LLF.q": 1.0}], workers=workers)


def test_a_lost_worker_is_one_run_error(monkeypatch: pytest.MonkeyPatch) -> None:
    parent = os.getpid()

    def killed(*_arguments: object) -> Evaluation:
        assert os.getpid() != parent
        os.kill(os.getpid(), signal.SIGKILL)
        raise AssertionError

    if batch.start_context().get_start_method() != "fork":
        pytest.skip("the patch reaches forked workers only")
    monkeypatch.setattr(batch, "evaluate", killed)
    monkeypatch.setattr(batch, "CHUNK", 1)
    with pytest.raises(RunError, match=r"worker process.*fewer --workers"):
        evaluate_all(axle(), moved(6), workers=2)


def test_windows_reach_the_reduction() -> None:
    index = list(CHARACTERISTICS).index("vertical.ride_rate")
    narrow, wide = (evaluate(axle(), {}, {"vertical": w}).characteristics[index] for w in (5.0, 80.0))
    assert abs(wide / narrow - 1.0) > 0.01


def test_there_is_a_core() -> None:
    assert 1 <= available_cores() <= (os.cpu_count() or 1)
