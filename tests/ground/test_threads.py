"""Numbers do not depend on how many threads linear algebra had before."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Executor

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from doe_kc.axle import design_parameters
from doe_kc.axle_file import read_axle
from doe_kc.campaign.executors import processes
from doe_kc.correlation.loop import run_method
from doe_kc.correlation.methods import METHODS, MethodSettings
from doe_kc.ground.threads import one_thread
from doe_kc.measurement import infer_ride_height, reduce_measurement
from doe_kc.parameter_influence.study import influence_study
from doe_kc.solver.curve_set import curve_set
from doe_kc.solver.suite import solve
from doe_kc.surrogate_models.study import fit_study
from doe_kc.workflow.measure import vertical_scatter
from tests.correlation.synthetic import solver as synthetic_solver
from tests.correlation.synthetic import synthetic
from tests.reference import EXAMPLE

pytestmark = pytest.mark.skipif((os.cpu_count() or 1) < 2, reason="one core has one thread")


def blas_threads() -> set[int]:
    return {lib["num_threads"] for lib in threadpool_info() if lib["user_api"] == "blas"}


def test_inside_there_is_one_and_afterwards_what_was_before() -> None:
    with threadpool_limits(2):
        before = blas_threads()
        with one_thread():
            assert blas_threads() == {1}
        assert blas_threads() == before and max(before) == 2


def test_a_worker_has_one() -> None:
    with threadpool_limits(2):
        executor: Executor
        with processes(2) as executor:
            assert executor.submit(blas_threads).result() == {1}


def test_a_ride_height() -> None:
    axle = read_axle(EXAMPLE / "axle.toml")
    solution = solve(axle, ["vertical"])
    estimates = set()
    for count in (1, 2):
        with threadpool_limits(count):
            measurement = reduce_measurement(EXAMPLE / "rig")
            estimates.add(
                infer_ride_height(
                    measurement.curves,
                    curve_set(solution),
                    measurement.noise["vertical"],
                    scatter=vertical_scatter(axle, solution),
                ).estimate
            )
    assert len(estimates) == 1


def correlation(watch: Callable[[object], None]) -> None:
    case = synthetic(4)
    run_method(
        case,
        METHODS["ego"](case, MethodSettings(seed=1, budget=3)),
        synthetic_solver(case),
        budget=3,
        watch=watch,
    )


def influence(watch: Callable[[object], None]) -> None:
    axle = read_axle(EXAMPLE / "axle.toml")
    influence_study(
        axle, [p for p in design_parameters(axle) if p.path == "LLF.z"], workers=1, progress=watch
    )


def surrogates(watch: Callable[[object], None]) -> None:
    x = np.random.default_rng(1).random((12, 2))
    fit_study(x, x, models=["linear"], workers=1, progress=watch)


@pytest.mark.parametrize("work", [correlation, influence, surrogates])
def test_work_called_from_python_has_one(work: Callable[[Callable[[object], None]], None]) -> None:
    seen: set[int] = set()
    with threadpool_limits(2):
        work(lambda _: seen.update(blas_threads()))
    assert seen == {1}
