"""The way to the most probable point: derivatives that serve, fits that are given up, chord steps."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import ClassVar

import numpy as np
import pytest

from doe_kc.discovery import gauss_newton
from doe_kc.discovery.derivatives import amplitude_differences
from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.gauss_newton import chord_fit, fit, known_columns
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import AMPLITUDE_STEP, FIT_DECREASE
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import Failure, NotConverged
from tests.discovery.cases import library


def test_the_minimum_is_one(with_hub: Fit) -> None:
    assert with_hub.converged
    rng = np.random.default_rng(3)
    for _ in range(5):
        near = with_hub.z + 0.3 * rng.standard_normal(with_hub.z.size) * np.sqrt(np.diag(with_hub.covariance))
        near = np.clip(near, with_hub.model.lower, with_hub.model.upper)
        assert cost_of(with_hub.model, near, with_hub.model.residual(near)) > with_hub.cost - 0.5


def test_followed_goes_most_of_the_way_of_a_fit(with_hub: Fit) -> None:
    without = replace(with_hub.model, left_out="lateral")
    near, full = chord_fit(with_hub, without), fit(without, with_hub.z)
    start = cost_of(without, with_hub.z, with_hub.residual)
    assert full.cost <= near.cost + FIT_DECREASE < start
    assert near.cost - full.cost < 0.2 * (start - full.cost) + 0.5


def test_derivatives_that_are_known_are_not_taken_anew(with_hub: Fit) -> None:
    """Beside a member the derivatives of all others are known; a new one's are not."""
    (rod,) = library("tie_rod_compliance")[:1]
    extended = with_hub.model.extended(rod)
    known = known_columns(with_hub, extended)
    assert known.shape[1] == with_hub.model.calibrations.stop + len(extended.sizes)
    new = np.isnan(known).all(axis=0)
    assert new.sum() == len(rod.sizes) and new[-len(rod.sizes) :].all()
    back = known_columns(with_hub, with_hub.model.without(with_hub.model.members[0]))
    np.testing.assert_array_equal(back, with_hub.jacobian.own[:, : with_hub.model.calibrations.stop])


def test_a_fit_that_cannot_come_near_another_is_given_up(with_hub: Fit) -> None:
    """From far away, with the ceiling far below what it reaches: fewer solutions, no end."""
    start = with_hub.model.centre
    whole = fit(with_hub.model, start)
    early = fit(with_hub.model, start, ceiling=whole.cost - 1e6)
    assert whole.converged and not early.converged
    assert early.evaluations < whole.evaluations


def test_a_fit_near_its_ceiling_is_not_given_up_on_derivatives_of_another(with_hub: Fit) -> None:
    """Those of a model nearby say nothing of what only its own show."""
    model, z = with_hub.model, with_hub.z.copy()
    z[: model.parameters] += 0.05 * model.prior_sd[: model.parameters]
    flat = known_columns(with_hub, model)
    flat[:, : model.parameters] *= 0.01
    reached = fit(model, z, known=flat)
    again = fit(model, z, known=flat, ceiling=reached.cost + 1.0)
    assert again.converged and again.cost == pytest.approx(reached.cost, abs=0.1)


class Locked(EffectModel):
    """A model whose axle has no equilibrium where the last size is beyond `lock`."""

    lock: ClassVar[float]

    def residual(self, z: FloatArray) -> FloatArray:
        if z[-1] > self.lock:
            failure = Failure("steer", "load", 1, 415.0, "deg", 412.0, "rack moved by 60 mm", "it locks")
            raise NotConverged(failure)
        return super().residual(z)


def locked(found: Fit, size: float) -> Locked:
    """The model of a fit that locks half a step of the differences beyond a size."""
    shown = {f.name: getattr(found.model, f.name) for f in fields(found.model)}
    return type("LockedHere", (Locked,), {"lock": size + 0.5 * AMPLITUDE_STEP})(**shown)


def test_at_the_edge_of_what_the_axle_can_do_a_derivative_is_taken_from_the_other_side(with_hub: Fit) -> None:
    """A steering case that was held out ended 0.4 deg before full lock, and the discovery with it."""
    model, z, residual = locked(with_hub, with_hub.z[-1]), with_hub.z, with_hub.residual
    places = [z.size - 1]
    with pytest.raises(NotConverged):
        model.residual(z + AMPLITUDE_STEP * np.eye(z.size)[-1])
    inside, whole = (amplitude_differences(m, z, residual, places) for m in (model, with_hub.model))
    assert np.linalg.norm(inside - whole) < 1e-3 * np.linalg.norm(whole)


def test_a_size_that_cannot_be_less_has_no_derivative_where_it_cannot_be_more(with_hub: Fit) -> None:
    z = with_hub.z.copy()
    z[-1] = with_hub.model.lower[-1]
    model = locked(with_hub, z[-1])
    with pytest.raises(NotConverged):
        amplitude_differences(model, z, model.residual(z), [z.size - 1])


def test_a_fit_ends_inside_what_the_axle_can_do(with_hub: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where derivatives cannot be taken on either side, a step is shortened and the fit still ends."""
    start = with_hub.z.copy()
    start[: with_hub.model.parameters] += 0.2 * with_hub.model.prior_sd[: with_hub.model.parameters]
    calls = [0]

    def refuse(model: EffectModel, *rest: object) -> FloatArray:
        calls[0] += 1
        if calls[0] > 1:
            raise NotConverged(Failure("steer", "load", 1, 1.0, "deg", 0.0, "", "it locks"))
        return own(model, *rest)  # type: ignore[arg-type]

    own = gauss_newton.own_columns
    monkeypatch.setattr(gauss_newton, "own_columns", refuse)
    found = fit(with_hub.model, start)
    assert calls[0] > 1 and np.isfinite(found.cost)
    assert found.cost <= cost_of(with_hub.model, start, with_hub.model.residual(start))


class Stopped(EffectModel):
    """A model whose first parameter does not show, until a stop touches below `clearance`: the cost leaps."""

    clearance: ClassVar[float]

    def residual(self, z: FloatArray) -> FloatArray:
        out = super().residual(np.concatenate([[self.clearance], z[1:]]))
        out[0] += 1e4 * max(0.0, self.clearance - z[0])
        return out


def test_a_stop_that_touches_does_not_hold_the_others_back(
    with_hub: Fit, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The prior pulls its clearance into contact at every step: the others go on without it."""
    shown = {f.name: getattr(with_hub.model, f.name) for f in fields(with_hub.model)}
    own = gauss_newton.own_columns

    def columns(model: EffectModel, *rest: object) -> FloatArray:
        out = own(model, *rest)  # type: ignore[arg-type]
        out[:, 0] = 0.0
        return out

    monkeypatch.setattr(gauss_newton, "own_columns", columns)
    clearance = 0.9
    stopped: Stopped = type("StoppedHere", (Stopped,), {"clearance": clearance})(**shown)
    start = stopped.centre.copy()
    start[0] = clearance + 1e-3
    found = fit(stopped, start)
    monkeypatch.setattr(gauss_newton, "own_columns", own)
    free: Stopped = type("FreeHere", (Stopped,), {"clearance": clearance})(**shown)
    assert found.converged and found.z[0] >= clearance
    others = fit(free, np.concatenate([[clearance], with_hub.z[1:]]), known=found.jacobian.own)
    assert found.cost < others.cost + 1.0
