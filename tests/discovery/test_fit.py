"""The joint fit: gradient and Jacobian against differences, evidence against the closed form."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from scipy.stats import multivariate_normal, norm

from doe_kc.correlation.least_squares import bounded_step
from doe_kc.discovery.derivatives import (
    Directions,
    amplitude_columns,
    amplitude_differences,
    directions,
    own_columns,
)
from doe_kc.discovery.fit import Fit, amplitude_estimates, cost_of
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.baseline import tune, with_traces
from doe_kc.discovery.thresholds import TRACE_SD
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import ABSENT
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import library, model


def test_residual_and_its_derivatives_agree(with_hub: Fit) -> None:
    model, z = with_hub.model, with_hub.z
    rng = np.random.default_rng(2)
    step = 1e-4 * rng.standard_normal(z.size) * model.prior_sd
    change = model.residual(z + step) - model.residual(z - step)
    expected = 2.0 * own_columns(model, z, with_hub.residual) @ step
    assert np.linalg.norm(change - expected) < 0.01 * np.linalg.norm(expected)


def test_the_hidden_size_is_recovered(with_hub: Fit) -> None:
    sd = np.sqrt(np.diag(with_hub.covariance))[-2:]
    found = with_hub.amplitudes
    assert abs(found[0] - 6000.0 / 5000.0) < 3.0 * sd[0]
    assert abs(found[1] - 1.0) < 3.0 * sd[1]


def test_evidence_is_that_of_the_linear_gaussian_model() -> None:
    rng = np.random.default_rng(5)
    nominal = model("named")
    rows, count = 40, nominal.dimension
    jacobian = rng.standard_normal((rows, count))
    data = rng.standard_normal(rows)
    prior = nominal.prior_sd
    hessian = jacobian.T @ jacobian + np.diag(prior**-2.0)
    z = nominal.centre - np.linalg.solve(hessian, jacobian.T @ data)
    residual = data + jacobian @ (z - nominal.centre)

    class Small(EffectModel):
        used = np.ones(rows, dtype=bool)

    small = Small(nominal.axle, nominal.space, nominal.likelihood)
    found = Fit(small, z, residual, Jacobian(jacobian), cost_of(small, z, residual), 1, True)
    covariance = np.eye(rows) + (jacobian * prior**2) @ jacobian.T
    exact = multivariate_normal(np.zeros(rows), covariance).logpdf(data)
    assert found.evidence == pytest.approx(exact - rows * norm.logpdf(0.0), abs=1e-8)


def test_evidence_integrates_what_a_bound_holds_back_along_its_half_line() -> None:
    """The share of the unbounded posterior that lies inside, with a slope at the bound."""
    rng = np.random.default_rng(8)
    nominal = model("named")
    rows, count = 40, nominal.dimension
    jacobian = rng.standard_normal((rows, count))
    data = rng.standard_normal(rows)
    hessian = jacobian.T @ jacobian + np.diag(nominal.prior_sd**-2.0)
    free = nominal.centre - np.linalg.solve(hessian, jacobian.T @ data)
    sd = np.sqrt(np.linalg.inv(hessian)[0, 0])
    bound = float(free[0] + 1.3 * sd)

    def at(low: np.ndarray) -> Fit:
        class Bounded(EffectModel):
            used = np.ones(rows, dtype=bool)
            lower = low
            upper = np.full(count, np.inf)

        bounded = Bounded(nominal.axle, nominal.space, nominal.likelihood)
        start = np.maximum(nominal.centre, low)
        residual = data + jacobian @ (start - nominal.centre)
        slope = jacobian.T @ residual + nominal.prior_sd**-2.0 * (start - nominal.centre)
        z = start + bounded_step(hessian, slope, low - start, np.full(count, np.inf))
        z[0] = max(z[0], low[0])
        residual = data + jacobian @ (z - nominal.centre)
        return Fit(bounded, z, residual, Jacobian(jacobian), cost_of(bounded, z, residual), 1, True)

    open_, held = np.full(count, -np.inf), np.full(count, -np.inf)
    held[0] = bound
    assert at(held).held.tolist() == [True] + [False] * (count - 1)
    assert at(held).evidence - at(open_).evidence == pytest.approx(norm.logcdf(-1.3), abs=1e-6)


def moves(model: EffectModel, z: FloatArray, places: Sequence[int]) -> Directions:
    return directions(model, z, model.axle_at(z), places)


def test_exact_derivatives_to_sizes_are_those_of_differences() -> None:
    """Of a friction and its shape, a compliance and a preload."""
    members = [*library("steering_friction", "hub_compliance"), library("bushing_preload")[0]]
    car = model("friction", ("lateral", "steer"))
    for member in members:
        extended = car.extended(member)
        z = np.concatenate([car.centre, np.full(len(member.sizes), 0.4)])
        residual = extended.residual(z)
        exact = own_columns(extended, z, residual)[:, extended.calibrations.stop :]
        places = range(extended.dimension, z.size)
        differences = amplitude_differences(extended, z, residual, places)
        np.testing.assert_allclose(amplitude_columns(extended, z, residual, places), exact, atol=1e-9)
        assert np.linalg.norm(exact - differences) < 0.01 * np.linalg.norm(differences)


@pytest.mark.parametrize("place", ["LLR_L", "LLR_R"])
def test_derivatives_to_a_stiffness_beside_unequal_bushings_are_those_of_differences(place: str) -> None:
    (member,) = (h for h in library("left_right_asymmetry") if h.location == place)
    car = model("none", ("lateral", "steer")).extended(member)
    z = np.append(car.centre[: car.dimension], 1.5)
    residual = car.residual(z)
    own = own_columns(car, z, residual)
    places = [i for i, path in enumerate(car.space.paths) if path.startswith("llr.F")]
    assert places
    for i in places:
        step = 1e-3 * np.eye(z.size)[i]
        change = (car.residual(z + step) - car.residual(z - step)) / 2e-3
        assert np.linalg.norm(own[:, i] - change) < 1e-5 * np.linalg.norm(change) + 1e-4


@pytest.mark.parametrize(
    "effect", ["bushing_progression", "hub_compliance", "rubber_hysteresis", "steering_friction"]
)
def test_derivatives_to_a_size_that_stands_for_none_are_exact(effect: str) -> None:
    """To where the records first show it: from 0 up to ABSENT nothing changes."""
    member = library(effect)[0]
    car = model("friction", ("lateral", "steer")).extended(member)
    z = np.append(car.centre[: car.dimension], np.zeros(len(member.sizes)))
    places = range(car.dimension, z.size)
    assert moves(car, z, places).keys() == {str(i) for i in places}
    residual, step = car.residual(z), 1e-3
    columns = amplitude_columns(car, z, residual, places)
    for column, size, i in zip(columns.T, member.sizes, places, strict=True):
        if not size.shape:
            beyond = car.residual(z + step * np.eye(z.size)[i])
            difference = (beyond - residual) / (step - ABSENT)
            assert np.linalg.norm(column - difference) < 0.02 * np.linalg.norm(difference) + 1e-3, size.name


@pytest.mark.parametrize("fault", ["rig_channel_gain", "rig_input_gain"])
def test_derivatives_beside_a_fault_of_the_rig_are_those_of_differences(fault: str) -> None:
    """Exact to the axle and its effects, whatever the rig reads of it."""
    (hub,) = library("hub_compliance")
    wrong = next(h for h in EFFECTS[fault].hypotheses() if h.location in ("toe", "lateral"))
    car = model("named", ("lateral",)).extended(hub).extended(wrong)
    z = np.concatenate([car.centre[: car.dimension], [0.5, 0.4, 2.0]])
    residual = car.residual(z)
    places = range(car.dimension, z.size)
    assert moves(car, z, places).keys() == {str(car.dimension), str(car.dimension + 1)}
    own = own_columns(car, z, residual)
    differences = amplitude_differences(car, z, residual, places)
    np.testing.assert_allclose(amplitude_columns(car, z, residual, places), own[:, -3:], atol=1e-9)
    assert np.linalg.norm(own[:, -3:] - differences) < 0.003 * np.linalg.norm(differences)
    moved = z.copy()
    moved[: car.parameters] += 1e-5
    change = (car.residual(moved) - residual) / 1e-5
    assert np.linalg.norm(own[:, : car.parameters].sum(axis=1) - change) < 0.003 * np.linalg.norm(change)


def test_without_derivatives_size_covariance_and_evidence_are_those_of_the_fit(with_hub: Fit) -> None:
    short = with_hub.without_derivatives
    assert short.jacobian.own.size == 0 and short.jacobian.size == with_hub.jacobian.size
    assert short.evidence == with_hub.evidence
    np.testing.assert_array_equal(short.covariance, with_hub.covariance)
    np.testing.assert_array_equal(short.held, with_hub.held)
    np.testing.assert_array_equal(short.without_derivatives.gradient, with_hub.gradient)


@pytest.mark.parametrize(("at", "shared_with", "share"), [(0, (1, 2), 0.5), (1, (0,), 1.0), (2, (0,), 1.0)])
def test_the_size_of_an_effect_has_what_its_traces_share_of_it(
    at: int, shared_with: tuple[int, ...], share: float
) -> None:
    """Moved from a free play to its traces, nothing changes but the prior's cost: on both sides to those of
    either, of which it is the mean; on one side to that of both, less that of the other side."""
    bare = tune(model("named"))
    places = library("tie_rod_free_play")
    member = places[at]
    traced = with_traces(bare, DiscoveryWorkers().screenings(bare, list(places)))
    beside = traced.model.extended(member)
    assert traced.model.nuisances is not None
    names = [f"{t.hypothesis.name} {t.size.name}" for t in traced.model.nuisances.traces]
    traces = [beside.traces.start + names.index(f"{h.name} gap_mm") for h in places]
    shared = [traces[i] for i in shared_with]
    z = np.append(traced.z, [0.5, 1.0])
    moved = z.copy()
    moved[-2] -= TRACE_SD
    moved[shared] += 1.0
    if at:
        moved[traces[3 - at]] -= 1.0
    change = beside.residual(z) - bare.residual
    assert np.linalg.norm(beside.residual(moved) - beside.residual(z)) < 0.03 * np.linalg.norm(change)
    blank = Jacobian(np.zeros((bare.residual.size, z.size)))
    sizes = [
        amplitude_estimates(Fit(beside, there, bare.residual, blank, 0.0, 1, True), member)[0]
        for there in (z, moved)
    ]
    np.testing.assert_allclose(sizes[0], sizes[1])
    assert sizes[0][0] == pytest.approx(0.5 + share * TRACE_SD * z[shared].sum())
