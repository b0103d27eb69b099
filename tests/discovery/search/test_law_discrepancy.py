"""The shape of laws: granted where an effect works, as far as the records ask for, and not as a scale."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, cost_of, rewhitened_fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.linear_nuisances import LinearNuisances
from doe_kc.discovery.search.law_discrepancy import (
    effect_signals,
    fit_discrepancy,
    marginal,
    with_discrepancy,
)
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import apply_effect
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import library, model

SHARE = 0.1


def at(car: str, member: Hypothesis, z: FloatArray) -> Fit:
    """A fit that stands where it is told to."""
    extended = model(car).extended(member)
    residual = extended.residual(z)
    jacobian = Jacobian(np.zeros((residual.size, z.size)))
    return Fit(extended, z, residual, jacobian, cost_of(extended, z, residual), 1, True)


def test_only_what_the_effect_changes_is_widened() -> None:
    (friction,) = library("steering_friction")
    z = np.append(model("friction").centre, [0.8, 0.0])
    found = at("friction", friction, z)
    wide = with_discrepancy(found.model.likelihood, effect_signals(found, DiscoveryWorkers()), [SHARE])
    before = {(c.load_case, c.response, c.side, c.branches): c for c in found.model.likelihood.curves}
    for curve in wide.curves:
        was = before[curve.load_case, curve.response, curve.side, curve.branches]
        grown = np.trace(curve.root @ curve.root.T) / np.trace(was.root @ was.root.T)
        if (curve.load_case, curve.response, curve.branches) == ("steer", "toe", "half_width"):
            assert grown > 2.0
        if curve.load_case == "lateral_opposite" and curve.response == "tyre_load":
            assert grown < 1.05


def test_a_compliance_is_no_friction_on_an_axle_that_has_one_already() -> None:
    (hub,), (friction,) = library("hub_compliance"), library("strut_friction")
    z = np.append(model("named").centre, [1.0, 1.0])
    found = at("named", hub, z)
    axle = apply_effect(found.model.axle, friction.effect, {"force_N": 100.0}, source="axle")
    beside = replace(found, model=replace(found.model, axle=axle))
    assert axle.topology.frictional
    assert [s.friction for s in effect_signals(beside, DiscoveryWorkers())] == [False]


def test_a_change_of_scale_is_no_shape() -> None:
    (hub,) = library("hub_compliance")
    z = np.append(model("named").centre, [1.0, 1.0])
    found = at("named", hub, z)
    made = found.residual - model("named").residual(z[:-2])
    wide = with_discrepancy(found.model.likelihood, effect_signals(found, DiscoveryWorkers()), [SHARE])
    for (curve, place), now in zip(found.model.likelihood.slices(), wide.curves, strict=True):
        if (curve.load_case, curve.response, curve.branches) == ("lateral", "camber", "mean"):
            change = curve.root @ made[place]
            before = np.linalg.norm(curve.whitened(change))
            bent = np.linalg.norm(now.whitened(change * np.cos(3.0 * curve.input / curve.input.max())))
            assert np.linalg.norm(now.whitened(change)) > 0.5 * before
            assert bent < 0.5 * np.linalg.norm(
                curve.whitened(change * np.cos(3.0 * curve.input / curve.input.max()))
            )


def fitted(car: str, ident: str, likelihood: Likelihood | None = None) -> Fit:
    (member,) = library(ident)
    extended = model(car).extended(member)
    if likelihood is not None:
        extended = replace(extended, likelihood=likelihood)
    start = extended.centre.copy()
    start[-len(member.sizes)] = 1.0
    return fit(extended, start)


@pytest.mark.parametrize(("car", "ident"), [("named", "hub_compliance"), ("friction", "steering_friction")])
def test_a_law_that_fits_stays_closed(car: str, ident: str) -> None:
    exact = fitted(car, ident)
    found, shares = fit_discrepancy(exact, effect_signals(exact, DiscoveryWorkers()))
    assert shares == {ident: 0.0}
    assert found is exact


def test_a_law_of_another_shape_is_opened() -> None:
    """Records of a hub that stiffens: what the effect makes is bent over the load."""
    straight = fitted("named", "hub_compliance")
    without = straight.model.without(straight.model.members[0])
    plain = without.residual(straight.z[:-2])
    curves = []
    for curve, place in straight.model.likelihood.slices():
        change = curve.root @ (straight.residual - plain)[place]
        relative = np.abs(curve.input) / np.abs(curve.input).max()
        curves.append(replace(curve, value=curve.value - 0.2 * relative * change))
    bent = replace(straight.model.likelihood, curves=tuple(curves))
    exact = fitted("named", "hub_compliance", bent)
    found, shares = fit_discrepancy(exact, effect_signals(exact, DiscoveryWorkers()))
    assert shares["hub_compliance"] >= 0.02
    assert marginal(found) > marginal(exact)
    assert np.diag(found.covariance)[-2] > np.diag(exact.covariance)[-2]


def test_other_errors_change_the_units_of_everything() -> None:
    """Model and fit stay each other's: differences between the sides are in the new errors too."""
    (hub,) = library("hub_compliance")
    plain = model("named").extended(hub)
    sides = LinearNuisances(np.random.default_rng(1).standard_normal((plain.likelihood.size, 2)))
    sided = replace(plain, nuisances=sides)
    z = sided.centre.copy()
    z[sided.dimension - 2 :] = 0.7, -1.2, 1.0, 0.5
    residual = sided.residual(z)
    jacobian = sided.jacobian(np.zeros((residual.size, z.size - 2)))
    found = Fit(sided, z, residual, jacobian, cost_of(sided, z, residual), 1, True)
    moved = rewhitened_fit(
        found, with_discrepancy(sided.likelihood, effect_signals(found, DiscoveryWorkers()), [SHARE])
    )
    np.testing.assert_allclose(moved.model.residual(z), moved.residual, rtol=0, atol=1e-8)
    assert np.abs(moved.residual - residual).max() > 0.1
    back = rewhitened_fit(moved, sided.likelihood)
    np.testing.assert_allclose(back.residual, residual, rtol=0, atol=1e-8)
