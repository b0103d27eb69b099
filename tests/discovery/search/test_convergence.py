"""Fits at their own optimum."""

from __future__ import annotations

from dataclasses import replace

import pytest

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, cost_of
from doe_kc.discovery.gauss_newton import refit_to_errors
from doe_kc.discovery.search.convergence import at_optimum, both_optima, fit_to_errors
from doe_kc.discovery.workers import DiscoveryWorkers
from tests.discovery.cases import discovery


def test_where_known_derivatives_lead_to_no_end_a_fit_takes_new_ones() -> None:
    """A linear hub in a car whose hub softens by 14 % was left 1190 of cost above its optimum."""
    last = discovery("named").search.with_effects
    z = last.z.copy()
    z[last.model.dimension :] *= 1.5
    own = last.jacobian.own.copy()
    own[:, last.model.linear.start :] *= 0.4  # steps that overshoot
    off = replace(last, z=z, residual=last.model.residual(z), jacobian=last.model.jacobian(own))
    likelihood = replace(last.model.likelihood)
    assert not refit_to_errors(off, likelihood).converged
    found = fit_to_errors(off, likelihood, DiscoveryWorkers())
    assert found.converged and found.model.likelihood is likelihood
    assert found.cost == pytest.approx(last.cost, abs=0.1)
    assert fit_to_errors(last, last.model.likelihood, DiscoveryWorkers()) is last
    assert at_optimum(last, DiscoveryWorkers()) is last


def _wider(likelihood: Likelihood, factor: float) -> Likelihood:
    return replace(likelihood, curves=tuple(replace(c, root=factor * c.root) for c in likelihood.curves))


def _ended_at(model_of: Fit, scale: float, likelihood: Likelihood) -> Fit:
    """As if a fit to other errors had ended with its effects at so many times their size."""
    z = model_of.z.copy()
    z[model_of.model.dimension :] *= scale
    model = model_of.model.with_likelihood(likelihood)
    residual = model.residual(z)
    jacobian = model.jacobian(model_of.jacobian.own / 2.0)
    cost = cost_of(model, z, residual)
    return replace(
        model_of, model=model, z=z, residual=residual, jacobian=jacobian, cost=cost, converged=True
    )


def test_a_fit_to_wider_errors_is_not_left_above_the_fit_to_the_own_ones() -> None:
    last, workers = discovery("named").search.with_effects, DiscoveryWorkers()
    wide = _wider(last.model.likelihood, 2.0)
    off = _ended_at(last, 1.5, wide)
    assert off.cost > last.cost
    again, exact = both_optima(off, last.model.likelihood, workers)
    assert exact.cost == pytest.approx(last.cost, abs=0.1)
    assert again.model.likelihood is wide and again.cost < exact.cost


def test_a_fit_to_wider_errors_that_costs_less_is_left_as_it_is() -> None:
    last, workers = discovery("named").search.with_effects, DiscoveryWorkers()
    there = _ended_at(last, 1.0, _wider(last.model.likelihood, 2.0))
    again, _ = both_optima(there, last.model.likelihood, workers)
    assert again is there
