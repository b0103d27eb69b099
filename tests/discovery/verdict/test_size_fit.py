"""The fit that sizes are told of: its errors, its scatter and what other laws would make of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import doe_kc.discovery.verdict.size_fit as size_fit_module
from doe_kc.discovery.fit import Fit, amplitude_estimates, cost_of
from doe_kc.discovery.gauss_newton import chord_fit
from doe_kc.discovery.gauss_newton import fit as optimum
from doe_kc.discovery.search.law_discrepancy import effect_signals
from doe_kc.discovery.search.law_variants import default_law, with_law
from doe_kc.discovery.thresholds import LAW_OPEN, LINEAR_TO
from doe_kc.discovery.verdict.size_fit import MODES, law_shifts, size_fit
from doe_kc.discovery.verdict.systematic_errors import systematic_scales
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects._friction import SHARES
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import discovery, library

SHARE = 0.05


def test_it_has_the_errors_and_the_scatter_of_the_records() -> None:
    search = discovery("pair").search
    last = search.with_law_discrepancy
    found = size_fit(search, DiscoveryWorkers()).fit
    assert found.converged
    assert found.model.members == last.model.members
    assert found.model.own_scatter is not None
    scales = systematic_scales(last)
    assert min(scales.values()) < 0.5, "records made without a rig's hysteresis"
    for before, after in zip(
        search.with_effects.model.likelihood.curves, found.model.likelihood.curves, strict=True
    ):
        for kind, error in before.systematic.items():
            np.testing.assert_allclose(after.systematic[kind], scales[kind] * error)


def test_sizes_stay_within_what_was_assumed() -> None:
    """Narrower errors of the same records: no size moves by more than it was open by, each gets sharper."""
    search = discovery("pair").search
    last, found = search.with_law_discrepancy, size_fit(search, DiscoveryWorkers()).fit
    before, after = (np.sqrt(np.diag(f.covariance))[f.model.dimension :] for f in (last, found))
    assert np.all(np.abs(found.amplitudes - last.amplitudes) < 2.0 * before)
    assert np.all(after < 1.05 * before)


def test_a_fit_that_known_derivatives_do_not_end_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """It ends as low, with the same sizes; shares of neighbouring sliders trade places."""
    search = discovery("pair").search
    ended = size_fit(search, DiscoveryWorkers()).fit

    def stopped(fit: Fit) -> Fit:
        away = ended.z.copy()
        away[ended.model.dimension] += 0.3
        return replace(ended, z=away, converged=False)

    monkeypatch.setattr(size_fit_module, "with_own_scatter", stopped)
    sized = size_fit(search, DiscoveryWorkers()).fit
    assert sized.converged
    sd = np.sqrt(np.diag(ended.covariance))[ended.model.dimension :]
    assert sized.cost < ended.cost + 0.1
    shares = np.array([size.key == SHARES for h in ended.model.members for size in h.sizes])
    assert np.all(np.abs(sized.amplitudes - ended.amplitudes)[~shares] < 0.3 * sd[~shares])


def test_a_compliance_is_not_linear_even_where_its_law_fits() -> None:
    """A friction whose law fits shifts nothing."""
    search = discovery("pair").search
    sized, signals = (
        size_fit(search, DiscoveryWorkers()).fit,
        effect_signals(search.with_effects, DiscoveryWorkers()),
    )
    names = [h.name for h in sized.model.members]
    assert names == ["hub_compliance", "steering_friction"]

    def shifts(hub: float, friction: float) -> FloatArray:
        by_member = law_shifts(sized, signals, {"hub_compliance": hub, "steering_friction": friction})
        assert list(by_member) == ["hub_compliance"]
        return by_member["hub_compliance"]

    fits = shifts(0.0, 0.0)
    assert fits.shape == (sized.z.size, MODES) and np.any(fits)
    np.testing.assert_array_equal(shifts(LAW_OPEN, 0.1), fits)
    np.testing.assert_allclose(shifts(2.0 * LAW_OPEN, 0.0), 2.0 * fits)


def test_shifts_are_those_of_records_that_follow_another_law() -> None:
    """Of a hub that is stiffer under load in every curve alike, against the fit to such records.

    Beside a friction by a closed law: the cost of a free shape is rough, and has another optimum there.
    """
    free = discovery("pair").search.with_law_discrepancy
    friction = next(h for h in free.model.members if h.law)
    last = optimum(*with_law(free.model, free.z, friction, default_law(friction)))
    model, signals = last.model, effect_signals(last, DiscoveryWorkers())
    hub = next(i for i, h in enumerate(model.members) if h.effect == "hub_compliance")
    shares = {h.name: SHARE * (i == hub) for i, h in enumerate(model.members)}
    (shifts,) = law_shifts(last, signals, shares).values()
    assert shifts.shape == (last.z.size, MODES)
    bent = []
    for curve, change in zip(model.likelihood.curves, signals[hub].changes, strict=True):
        relative = np.abs(curve.input) / np.abs(curve.input).max()
        bent.append(replace(curve, value=curve.value + SHARE * change * (0.5 - relative)))
    other = replace(model, likelihood=replace(model.likelihood, curves=tuple(bent)))
    residual = other.residual(last.z)
    cost = cost_of(other, last.z, residual)
    refit = chord_fit(replace(last, model=other, residual=residual, cost=cost), other)
    moved = refit.z - chord_fit(last, model).z
    sd = np.sqrt(np.diag(last.covariance))
    expected = np.linalg.norm(shifts, axis=1)
    large = np.abs(moved) > 0.05 * sd
    assert large.any()
    assert np.all(np.abs(moved[large]) < 2.0 * expected[large])
    assert np.median(np.abs(moved[large]) / expected[large]) > 0.1


def test_the_gap_of_a_free_play_has_no_law() -> None:
    """With rigid contacts nothing of it yields; with soft ones that part alone is open."""
    last = discovery("pair").search.with_law_discrepancy
    (play, *_) = library("tie_rod_free_play")
    model = replace(last.model, members=(play,))

    def shifts(contact: float) -> dict[str, FloatArray]:
        z = np.append(last.z[: model.dimension], [1.0, contact])
        own = np.hstack([last.jacobian.own[:, : -last.amplitudes.size], np.zeros((last.residual.size, 2))])
        at = replace(last, model=model, z=z, residual=model.residual(z), jacobian=model.jacobian(own))
        return law_shifts(at, effect_signals(at, DiscoveryWorkers()), {play.name: 0.0})

    assert not np.any(shifts(0.0)[play.name])
    assert np.any(shifts(1.0)[play.name])


def test_a_stiffness_is_one_number_to_a_share_at_best() -> None:
    """By its own law: more than the share is not added to it. Laws of others are beside it."""
    sized = size_fit(discovery("pair").search, DiscoveryWorkers())
    hub, friction = sized.fit.model.members
    (camber, _), _ = amplitude_estimates(sized.fit, hub)

    def share(**shifts: float) -> float:
        by_member = {name: x * np.outer(sized.fit.z, [0.6, 0.8]) for name, x in shifts.items()}
        return float(replace(sized, law_shifts=by_member).law_sd(hub)[0] / camber)

    assert share() == share(hub_compliance=0.5 * LINEAR_TO) == pytest.approx(LINEAR_TO)
    assert share(hub_compliance=3.0 * LINEAR_TO) == pytest.approx(3.0 * LINEAR_TO)
    assert share(strut_bending=0.05) == pytest.approx(np.hypot(0.05, LINEAR_TO))
    assert not np.any(replace(sized, law_shifts={}).law_sd(friction))
