"""The scatter that one car's records show, against the marginal likelihood that it is to maximize."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.nuisances import sided_variables
from doe_kc.discovery.result_cache import fingerprint
from doe_kc.discovery.thresholds import SCATTER_LOG_SD
from doe_kc.discovery.verdict.own_scatter import most_probable_scatter, unknown_groups, with_own_scatter
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import discovery


@pytest.fixture(scope="module")
def last() -> Fit:
    return discovery("pair").search.with_law_discrepancy


def log_posterior(fit: Fit, scatter: FloatArray) -> float:
    """ln density of the records at the quadratic through the fit, all unknowns integrated, and of the groups'
    scatters."""
    free, before = np.flatnonzero(~fit.held), fit.model.prior_sd**-2.0
    away = fit.z - fit.model.centre
    data = fit.hessian - np.diag(before)
    slope = fit.gradient - before * away
    pull = (data @ away - slope)[free] - data[np.ix_(free, fit.held.nonzero()[0])] @ away[fit.held]
    own = before * scatter**-2.0
    total = data[np.ix_(free, free)] + np.diag(own[free])
    out = 0.5 * float(pull @ np.linalg.solve(total, pull)) - 0.5 * float(np.linalg.slogdet(total)[1])
    out += 0.5 * float(np.sum(np.log(own))) - 0.5 * float(np.sum((own * away**2)[fit.held]))
    groups = [np.log(scatter[g.places[0]]) for g in unknown_groups(fit)]
    return out - 0.5 * float(np.sum(np.square(groups))) / SCATTER_LOG_SD**2


def test_it_is_the_most_probable_one(last: Fit) -> None:
    scatter = most_probable_scatter(last)
    best = log_posterior(last, scatter)
    assert best > log_posterior(last, np.ones(scatter.size)) + 1.0
    for group in unknown_groups(last):
        for factor in (0.97, 1.03):
            other = scatter.copy()
            other[group.places] *= factor
            assert log_posterior(last, other) < best, f"{group.name} by {factor}"


def test_what_is_made_set_or_measured_alike_has_one_each(last: Fit) -> None:
    scatter, model = most_probable_scatter(last), last.model
    groups = unknown_groups(last)
    assert {g.name for g in groups} == {
        "hardpoints",
        "bushings",
        "calibrations",
        "hardpoints between the sides",
        "bushings between the sides",
        "settings between the sides",
    }
    for group in groups:
        assert np.ptp(scatter[group.places]) == 0.0
    rest = np.setdiff1d(np.arange(scatter.size), np.concatenate([g.places for g in groups]))
    assert set(range(model.dimension, scatter.size)) <= set(rest), "sizes have their own prior"
    assert set(range(*model.traces.indices(scatter.size))) <= set(rest)
    np.testing.assert_array_equal(scatter[rest], 1.0)


def test_each_difference_between_the_sides_is_in_one_group(last: Fit) -> None:
    model, known = last.model, last.model.nuisances
    assert known is not None
    sided = sided_variables(model.axle, model.space)
    columns = list(range(model.linear.start, model.linear.start + known.sides))
    groups = {g.name: g.places.tolist() for g in unknown_groups(last) if "between the sides" in g.name}
    assert sorted(i for places in groups.values() for i in places) == columns
    for column, variable in zip(columns, sided, strict=True):
        (name,) = [n for n, places in groups.items() if column in places]
        own = variable.parameter.group.lower()
        assert name.removesuffix(" between the sides") == (
            own if own in ("hardpoints", "bushings") else "settings"
        )


def test_sides_that_are_not_known_have_no_scatter(last: Fit) -> None:
    known = last.model.nuisances
    assert known is not None
    traces = replace(known, columns=known.columns[:, known.sides :])
    fit = replace(last, model=replace(last.model, nuisances=traces))
    assert traces.sides == 0 and traces.traces
    assert {g.name for g in unknown_groups(fit)} == {"hardpoints", "bushings", "calibrations"}


def test_what_somebody_has_measured_keeps_its_own(last: Fit) -> None:
    space = last.model.space
    measured = [i for i, v in enumerate(space.variables) if v.parameter.group == "HARDPOINTS"][::2]
    variables = tuple(
        replace(v, distribution="gaussian") if i in measured else v for i, v in enumerate(space.variables)
    )
    fit = replace(last, model=replace(last.model, space=replace(space, variables=variables)))
    places = np.concatenate([g.places for g in unknown_groups(fit)])
    assert not set(measured) & set(places.tolist())


def test_records_that_show_nothing_leave_what_was_assumed(last: Fit) -> None:
    model = last.model
    none = replace(
        last,
        z=model.centre.copy(),
        residual=np.zeros_like(last.residual),
        jacobian=replace(last.jacobian, normal=np.zeros((last.z.size, last.z.size))),
    )
    np.testing.assert_allclose(most_probable_scatter(none), 1.0, rtol=1e-2)


def test_sizes_are_estimated_with_it(last: Fit) -> None:
    own, scatter = with_own_scatter(last), most_probable_scatter(last)
    np.testing.assert_allclose(own.model.prior_sd, scatter * last.model.prior_sd)
    assert own.converged
    assert np.all(
        np.abs(own.amplitudes - last.amplitudes) < np.sqrt(np.diag(last.covariance))[last.model.dimension :]
    )
    assert fingerprint(own.model) != fingerprint(last.model)
