"""Traces of absent effects: unknowns of the fit, none of an effect that is in the model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from doe_kc.correlation.likelihood import Rewhitening
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import chord_fit
from doe_kc.discovery.linear_nuisances import LinearNuisances, Trace, trace_mean
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.screening.screen import screen
from doe_kc.discovery.search.baseline import tune, with_traces
from doe_kc.discovery.thresholds import TRACE_SD
from tests.discovery.cases import library, model


@pytest.fixture(scope="module")
def tuned() -> Fit:
    return tune(model("none"))


@pytest.fixture(scope="module")
def cluttered(tuned: Fit) -> Fit:
    return with_traces(tuned, [screen(tuned, h) for h in library("hub_compliance", "tie_rod_compliance")])


def test_traces_are_of_amounts_at_three_per_cent(tuned: Fit, cluttered: Fit) -> None:
    known = cluttered.model.nuisances
    assert known is not None
    assert {t.hypothesis.name for t in known.traces} == {"hub_compliance", "tie_rod_compliance"}
    (rod,) = library("tie_rod_compliance")
    column = screen(tuned, rod).columns[:, 0]
    own = known.columns[:, known.count - len(known.traces) + known.traces.index(Trace(rod, 0))]
    np.testing.assert_allclose(own, TRACE_SD * column)


def test_what_every_car_has_some_of_is_exponential_before_the_records(cluttered: Fit) -> None:
    """Of an exponential distribution the mean is the standard deviation; all others have a mean of zero."""
    known = cluttered.model.nuisances
    assert known is not None
    np.testing.assert_array_equal(known.centre, 0.0)
    (mount,) = library("rack_mount_compliance")
    with_mount = known.with_traces([Trace(mount, 0)], np.ones((known.columns.shape[0], 1)))
    np.testing.assert_array_equal(with_mount.centre, [*known.centre, 1.0])
    assert trace_mean(mount.sizes[0]) == TRACE_SD
    model = replace(cluttered.model, nuisances=with_mount)
    np.testing.assert_array_equal(model.centre[model.linear], with_mount.centre)


def test_without_records_a_trace_is_its_mean(tuned: Fit) -> None:
    """A column that no record shows: nothing moves it from where it is before the records."""
    (mount,) = library("rack_mount_compliance")
    none = LinearNuisances(np.zeros((tuned.residual.size, 0)))
    traced = replace(
        tuned.model, nuisances=none.with_traces([Trace(mount, 0)], np.full((tuned.residual.size, 1), 1e-6))
    )
    start = np.concatenate([tuned.z[: traced.calibrations.stop], [0.0]])
    state = Fit(traced, start, traced.residual(start), traced.jacobian(tuned.jacobian.own), 0.0, 1, True)
    assert chord_fit(state, traced).z[-1] == pytest.approx(1.0, abs=1e-3)


def test_a_member_has_no_trace_beside_its_sizes(cluttered: Fit) -> None:
    (hub,) = library("hub_compliance")
    extended = cluttered.model.extended(hub)
    assert extended.dimension == cluttered.model.dimension
    known = extended.nuisances
    assert known is cluttered.model.nuisances and known is not None
    jacobian = extended.jacobian(np.zeros((extended.likelihood.size, extended.calibrations.stop + 2)))
    for trace, column in zip(known.traces, jacobian.dense[:, extended.traces].T, strict=True):
        assert bool(np.any(column)) is (trace.hypothesis != hub)
    unknown = np.concatenate([cluttered.z, [0.0, 0.0]])
    traced = unknown.copy()
    traced[extended.traces] += [t.hypothesis == hub for t in known.traces]
    np.testing.assert_array_equal(extended.residual(traced), extended.residual(unknown))


def test_sizes_have_the_variance_of_what_is_left_out(tuned: Fit) -> None:
    """The covariance with traces is that of records with S + t^2 c c' as error."""
    (hub,) = library("hub_compliance")
    (rod,) = library("tie_rod_compliance")
    column = screen(tuned, rod).columns[:, 0]
    assert tuned.model.nuisances is not None
    traced = tuned.model.nuisances.with_traces([Trace(rod, 0)], TRACE_SD * column[:, None])
    wide: EffectModel = replace(tuned.model, nuisances=traced).extended(hub)
    z = np.concatenate([tuned.z, [0.0], [0.5, 0.5]])
    sizes = np.random.default_rng(3).standard_normal((tuned.residual.size, 2))
    jacobian = wide.jacobian(np.hstack([tuned.jacobian.own, sizes]))
    fit = Fit(wide, z, tuned.residual, jacobian, 0.0, 1, True)
    seen = np.hstack([tuned.jacobian.dense, sizes])
    shared = TRACE_SD**2 / (1.0 + TRACE_SD**2 * (column @ column))  # of (I + t^2 c c')^-1, Sherman-Morrison
    weighted = seen - shared * np.outer(column, column @ seen)
    prior = np.concatenate([tuned.model.prior_sd, np.ones(2)])
    expected = np.linalg.inv(seen.T @ weighted + np.diag(prior**-2.0))
    np.testing.assert_allclose(fit.covariance[-2:, -2:], expected[-2:, -2:], rtol=1e-6)


def test_other_errors_change_the_units_of_traces(cluttered: Fit) -> None:
    model, known = cluttered.model, cluttered.model.nuisances
    curves = tuple(replace(c, root=2.0 * c.root) for c in model.likelihood.curves)
    wide = model.with_likelihood(replace(model.likelihood, curves=curves))
    assert known is not None and wide.nuisances is not None
    expected = Rewhitening(model.likelihood, wide.likelihood)(known.columns)
    np.testing.assert_allclose(wide.nuisances.columns, expected)
    np.testing.assert_allclose(wide.nuisances.columns[:10], 0.5 * known.columns[:10])
