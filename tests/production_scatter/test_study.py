"""The study on the example axle: the true solver against first order, the store, failures, requirements."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from doe_kc.characteristics import CHARACTERISTICS, characteristics_of
from doe_kc.curves import CaseCurves
from doe_kc.ground.errors import InputError, RunError
from doe_kc.production_scatter.bands import BandCollector
from doe_kc.production_scatter.options import RequirementOptions
from doe_kc.production_scatter.requirements import Requirement, build_requirements
from doe_kc.production_scatter.result import MeasuredCar, Tolerance
from doe_kc.production_scatter.study import FITTED_SLOPES, tolerance_study
from doe_kc.true_solver.outcome import Outcome, failure
from doe_kc.true_solver.own import AxleSolver
from doe_kc.true_solver.protocol import Values
from tests.production_scatter.cases import FEW, example, scatter_of

BUMP = "vertical.bump_steer"


def solved(n: int, store: Path | None, **table: object) -> Tolerance:
    requirement = Requirement(CHARACTERISTICS[BUMP], -5.0, -3.0)
    return tolerance_study(
        example(), AxleSolver(example()), scatter_of(**{"parameters": FEW, **table}), n=n, seed=1,
        requirements={BUMP: requirement}, store=store, workers=1,
    )  # fmt: skip


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("tolerance") / "cars.sqlite"


@pytest.fixture(scope="module")
def wide(store: Path) -> Tolerance:
    return solved(60, store)


def test_small_scatter_is_that_of_first_order() -> None:
    """Every car of the true solver, with deviations a hundredth as large, is its first order to 1 %."""
    small = [
        {"match": "*.?", "sd": 0.01},
        {"match": "llr.Fx", "sd": 0.002},
        {"match": "arb.radius", "sd": 0.003},
    ]
    done = solved(30, None, scatter=small)
    change = done.first_order.changes(done.deviations)
    actual = done.values - done.nominal
    for k in range(len(done.characteristics)):
        np.testing.assert_allclose(actual[:, k], change[:, k], atol=0.01 * np.abs(change[:, k]).max())
        assert done.scatters[k].explained > 0.9999 and done.scatters[k].linear
    np.testing.assert_allclose(done.first_shares, done.totals.shares, atol=0.02)
    np.testing.assert_allclose(done.first_shares.sum(axis=0), 1.0)


def test_what_is_in_the_store_is_not_solved_again(wide: Tolerance, store: Path) -> None:
    assert wide.n == 60 and not wide.failures
    again = solved(60, store)
    assert again.runs == 0
    np.testing.assert_array_equal(again.values, wide.values)
    assert solved(65, store).runs == 5


def test_its_cars_are_outside_their_requirement(wide: Tolerance) -> None:
    k = [c.id for c in wide.characteristics].index(BUMP)
    outside = (wide.values[:, k] < -5.0) | (wide.values[:, k] > -3.0)
    assert wide.any_outside.count == outside.sum() and 0 < outside.sum() < 60
    assert wide.missed == pytest.approx(outside.mean())
    scatter = wide.scatters[k]
    assert scatter.outside is not None and scatter.outside.count == outside.sum()
    assert scatter.moments.sd == pytest.approx(scatter.first_order_sd, rel=0.3)
    best = max(wide.tightenings, key=lambda t: -t.sd_ratio[k])
    assert best.scatter.parameter.path in ("ROB.z", "LLF.z")


def test_the_bands_hold_the_cars(wide: Tolerance) -> None:
    band = next(b for b in wide.bands if b.load_case == "vertical")
    low, quarter, middle, upper, high = band.percentiles["toe"]
    assert np.all(low <= quarter) and np.all(quarter <= middle) and np.all(upper <= high)
    zero = int(np.argmin(np.abs(band.input)))
    assert np.abs(band.percentiles["toe"][:, :, zero]).max() < 1e-6
    nominal = CaseCurves("vertical", "mm", band.input, {"toe": band.nominal["toe"]}, {})
    np.testing.assert_allclose(band.inside(nominal, "toe"), 1.0)
    off = CaseCurves("vertical", "mm", band.input, {"toe": band.nominal["toe"] + 9.0}, {})
    np.testing.assert_allclose(band.inside(off, "toe"), 0.0)


def test_percentiles_of_bands(wide: Tolerance) -> None:
    nominal = AxleSolver(example()).evaluate({}).curves
    assert nominal is not None
    collector = BandCollector(nominal, ["toe"])
    collector.add([nominal] * 3)
    for band in collector.bands():
        np.testing.assert_allclose(band.percentiles["toe"][0], band.nominal["toe"], atol=1e-5)


def test_a_measured_car_has_its_place(wide: Tolerance) -> None:
    from dataclasses import replace

    nominal = AxleSolver(example()).evaluate({})
    assert nominal.curves is not None
    car = MeasuredCar("a", dict(zip(CHARACTERISTICS, nominal.characteristics, strict=True)), nominal.curves)
    scatter = next(s for s in replace(wide, cars=(car,)).scatters if s.entry.id == BUMP)
    value, percent = scatter.measured["a"]
    assert value == pytest.approx(scatter.nominal) and 25.0 < percent < 75.0


class Reluctant(AxleSolver):
    """Fails where the left tie rod is too high."""

    def evaluate(self, values: Values) -> Outcome:
        if values["left.ROB.z"] > self.axle.values["ROB.z@L"] + self.edge:
            return failure("no equilibrium")
        return super().evaluate(values)

    edge = 0.8


class Foreign(AxleSolver):
    """An outside solver: without slopes."""

    @property
    def exact(self) -> bool:
        return False


def test_cars_without_equilibrium_are_left_out() -> None:
    model = scatter_of(parameters=["ROB.z"])
    done = tolerance_study(example(), Reluctant(example()), model, n=30, seed=1, requirements={}, workers=1)
    assert done.failures and done.n + len(done.failures) == 30
    assert done.deviations[:, 0].max() <= 0.8 and len(done.deviations) == done.n
    Reluctant.edge = -1.0
    with pytest.raises(RunError, match="the nominal axle cannot be solved: no equilibrium"):
        tolerance_study(example(), Reluctant(example()), model, n=30, seed=1, requirements={}, workers=1)
    Reluctant.edge = 0.001
    with pytest.raises(RunError, match=r"of 30 cars have no equilibrium, the first: no equilibrium; make"):
        tolerance_study(example(), Reluctant(example()), model, n=30, seed=4, requirements={}, workers=1)


def test_slopes_of_a_solver_without_any_are_fitted(wide: Tolerance, store: Path) -> None:
    model = scatter_of(parameters=FEW)
    done = tolerance_study(
        example(), Foreign(example()), model, n=60, seed=1, requirements={}, store=store, workers=1
    )
    assert done.first_order.source == FITTED_SLOPES and done.runs == 0
    k = [c.id for c in done.characteristics].index(BUMP)
    scale = np.abs(wide.first_order.slopes[k]).max()
    np.testing.assert_allclose(done.first_order.slopes[k], wide.first_order.slopes[k], atol=0.05 * scale)
    led = tolerance_study(
        example(), Foreign(example()), model, n=60, seed=1, requirements={}, store=store, workers=1,
        twin=example(),
    )  # fmt: skip
    np.testing.assert_allclose(led.first_order.slopes, wide.first_order.slopes)


def test_requirements_by_name() -> None:
    entries = characteristics_of(example())
    stated = [RequirementOptions(match="vertical.*", high=9.0), RequirementOptions(match=BUMP, low=-5.0)]
    built = build_requirements(entries, stated, None, "s")
    assert built[BUMP].low == -5.0 and built[BUMP].high == np.inf
    assert built["vertical.ride_rate"].high == 9.0 and "static.toe" not in built
    with pytest.raises(InputError, match=r"tolerance.requirement: match = 'vertical.bumpsteer' fits no char"):
        build_requirements(entries, [RequirementOptions(match="vertical.bumpsteer", low=0.0)], None, "s")
