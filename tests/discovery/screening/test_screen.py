"""Screening: the score test in closed form where effects are linear, sizes where they are not."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.stats import norm

from doe_kc.correlation.likelihood import Rewhitening
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import fit
from doe_kc.discovery.jacobian import Jacobian
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.projection import Projection, changes
from doe_kc.discovery.screening import screen as screen_module
from doe_kc.discovery.screening.score_test import score_tests
from doe_kc.discovery.screening.screen import amplitude_solution, rewhitened_screenings, screen, shape_of
from doe_kc.discovery.thresholds import PROBE, PROBE_FACTOR, SHAPE_STARTS, TRACE_SD
from doe_kc.discovery.verdict.exclusion import hypothesis_statuses, trusted_detectability, wrong_name_chance
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged
from tests.discovery.cases import discovery, library, model


def test_the_hidden_effect_gains_most(tuned: Fit) -> None:
    gains = {h.name: screen(tuned, h).gain for h in library("hub_compliance", "strut_friction")}
    assert gains["hub_compliance"] > 50.0
    assert gains["strut_friction"] < 3.0


@pytest.mark.parametrize(("most", "fails"), [(0.5, False), (0.1, False), (0.01, True)])
def test_an_effect_that_has_equilibria_when_small_is_screened_from_there(
    most: float, fails: bool, tuned: Fit, monkeypatch: pytest.MonkeyPatch
) -> None:
    """most: amplitude beyond which none is found."""
    (hub,) = library("hub_compliance")
    whole, solved = screen(tuned, hub), EffectModel.residual

    def residual(model: EffectModel, z: FloatArray) -> FloatArray:
        if z.size > tuned.z.size and np.abs(z[tuned.z.size :]).max() > most:
            raise NotConverged("too far")
        return solved(model, z)

    monkeypatch.setattr(EffectModel, "residual", residual)
    near = screen(tuned, hub)
    assert bool(near.failed) == fails
    if not fails:
        assert near.gain > 50.0 and np.abs(near.amplitudes).max() <= most
        assert np.linalg.norm(near.change - whole.change) < 0.1 * np.linalg.norm(whole.change)


def test_an_effect_of_one_parameter_absorbed_by_another_is_not_detectable(tuned: Fit) -> None:
    by_name = {h.name: screen(tuned, h) for h in library("bushing_progression")}
    weak = by_name["bushing_progression SFR"]
    assert weak.detectability < 1.0
    assert 0.0 <= weak.absorbed <= 1.0


def test_what_a_size_shows_is_what_the_other_sizes_cannot_imitate(tuned: Fit) -> None:
    (hub,) = library("hub_compliance")
    found = screen(tuned, hub)
    gram = tuned.projection.gram_of(tuned.changes(found.columns))
    for own, other in ((0, 1), (1, 0)):
        rest = gram[own, own] - gram[own, other] ** 2 / gram[other, other]
        assert found.size_detectability[own] == pytest.approx(np.sqrt(rest), rel=1e-4)
    (again,) = score_tests(tuned, [found])
    assert again.size_detectability == pytest.approx(found.size_detectability, rel=1e-9)
    assert found.size_detectability.min() < found.detectability


def test_a_shape_is_not_seen_by_itself(tuned: Fit) -> None:
    (friction,) = library("strut_friction")
    found = screen(tuned, friction)
    amounts = [not s.shape for s in friction.sizes]
    assert found.size_detectability[amounts] == pytest.approx(found.detectability)
    assert np.isnan(found.size_detectability[~np.array(amounts)]).all()


@pytest.mark.parametrize("effect", ["steering_friction", "strut_friction"])
def test_the_shape_that_promises_most_is_begun_with(effect: str) -> None:
    """One solution a shape chooses it; followed from each of them, none gains much more."""
    car = model("friction")
    without, (friction,) = fit(car, car.centre), library(effect)
    count = sum(s.shape for s in friction.sizes)
    each = [screen(without, friction, np.full(count, shape)) for shape in SHAPE_STARTS]
    chosen = screen(without, friction)
    assert any(np.array_equal(chosen.amplitudes, one.amplitudes) for one in each)
    assert chosen.gain > 0.9 * max(one.gain for one in each) - 1.0


def test_the_next_screening_begins_at_the_last_shape() -> None:
    (friction,) = library("steering_friction")
    none = np.zeros(2)
    last: Any = SimpleNamespace(hypothesis=friction, amplitudes=np.array([1.2, 7.0]))
    assert [s.shape for s in friction.sizes] == [False, True]
    np.testing.assert_array_equal(shape_of(last), [max(SHAPE_STARTS)])
    last.amplitudes = none
    np.testing.assert_array_equal(shape_of(last), [0.0])


def test_what_re_tuning_absorbs_but_for_a_trace_is_not_excluded(tuned: Fit) -> None:
    (friction,) = library("strut_friction")
    clear = screen(tuned, friction)
    followed = tuned.jacobian.moved(np.full(tuned.z.size, 0.3))  # what parameters do, and a trace besides
    followed += 0.05 * np.linalg.norm(followed) * clear.change / np.linalg.norm(clear.change)
    seen = float(np.sqrt(tuned.projection.squares(tuned.changes(followed))[0]))
    hidden = replace(clear, change=followed, detectability=seen)
    assert hidden.detectability > 10.0
    shown, unsure = hypothesis_statuses(tuned, [clear, hidden], [], 4.0, resolved=True)
    beside_trace = 4.84 * np.hypot(1.0 / clear.detectability, TRACE_SD)
    least = max(beside_trace, abs(clear.amplitudes[0]) + 1.645 * clear.sd[0])
    assert shown.status == "excluded" and shown.limits[0] == pytest.approx(least)
    open_, _ = hypothesis_statuses(tuned, [clear, hidden], [], 4.0, resolved=False)
    assert open_.status == "unresolved" and open_.limits[0] == shown.limits[0]
    assert unsure.status == "not testable" and unsure.detectable > 1.0 > 2.0 * 4.84 / hidden.detectability


def test_a_member_shows_by_its_fit_where_its_screening_was_blind() -> None:
    """Screened before what hid it came in; its sizes by the closed form of a Gaussian's information."""
    search = discovery("named").search
    last = search.with_law_discrepancy
    (hub,) = (s for s in search.screened if s.hypothesis.effect == "hub_compliance")
    blind = replace(hub, size_detectability=np.zeros_like(hub.size_detectability))
    seen, unseen = (
        hypothesis_statuses(last, [], [(s, "found")], 4.0, resolved=True)[0] for s in (hub, blind)
    )
    posterior = np.diag(last.covariance)[last.model.place(hub.hypothesis)]
    by_fit = 4.84 * np.hypot(1.0 / np.sqrt(1.0 / posterior - 1.0), TRACE_SD)
    np.testing.assert_allclose(unseen.limits, by_fit, rtol=1e-3)
    assert unseen.detectable == pytest.approx(min(by_fit), rel=1e-3)
    assert np.all(np.array(seen.limits) <= by_fit * 1.001)


def test_what_a_member_may_stand_for_is_not_excluded(tuned: Fit) -> None:
    """A mount of the rack of 7260 N/mm was excluded below 25 600 beside a friction on it, told as wide as a
    set with the mount."""
    mount, clear = (screen(tuned, h) for h in library("rack_mount_compliance", "strut_friction"))
    names = {mount.hypothesis.name}
    open_, shown = hypothesis_statuses(tuned, [mount, clear], [], 4.0, resolved=True, masked=names)
    assert open_.status == "not testable" and open_.limits[0] == np.inf
    assert shown.status == "excluded" and np.isfinite(shown.detectable)
    seen, _ = hypothesis_statuses(tuned, [mount, clear], [], 4.0, resolved=True)
    assert np.isfinite(seen.limits[0])


def test_what_every_car_has_some_of_is_excluded_above_its_mean(tuned: Fit) -> None:
    """The same columns, of an effect whose trace has a mean and of one whose trace has none."""
    (mount,) = library("rack_mount_compliance")
    clear = screen(tuned, mount)
    absent = replace(mount, sizes=tuple(replace(s, present=False) for s in mount.sizes))
    limits = [
        hypothesis_statuses(tuned, [replace(clear, hypothesis=h)], [], 4.0, resolved=True)[0].limits
        for h in (mount, absent)
    ]
    shapes = [s.shape for s in mount.sizes]
    assert not np.isinf(limits[1]).any()
    np.testing.assert_allclose(limits[0], np.add(limits[1], [0.0 if shape else TRACE_SD for shape in shapes]))


@pytest.mark.parametrize(("strength", "correlation"), [(2.0, 0.5), (4.0, 0.9), (6.0, 0.95)])
def test_wrong_name_chance_against_monte_carlo(strength: float, correlation: float) -> None:
    rng = np.random.default_rng(2)
    first = strength + rng.standard_normal(400_000)
    rest = rng.standard_normal(first.size)
    second = correlation * first + np.sqrt(1.0 - correlation**2) * rest
    frequency = float(np.mean(np.abs(second) > np.abs(first)))
    assert wrong_name_chance(strength, correlation) == pytest.approx(frequency, abs=0.003)


def test_ninety_nine_per_cent_right_needs_the_strength_of_the_closed_form() -> None:
    for correlation in (0.9, 0.95, 0.99):
        strength = norm.ppf(0.99) * np.sqrt(2.0 / (1.0 - correlation))
        assert wrong_name_chance(float(strength), correlation) == pytest.approx(0.01, abs=1e-3)


class Saturating:
    """A model of one effect that makes 200 a / (1 + 5 a) standard deviations of one datum, and a fit."""

    lower, upper, z = np.zeros(1), np.full(1, 6.0), np.zeros(0)

    def __init__(self, true: float) -> None:
        self.residual_of = -self.made(true)

    @staticmethod
    def made(a: float) -> np.ndarray:
        return np.array([200.0 * a / (1.0 + 5.0 * a)])

    def residual(self, z: np.ndarray) -> np.ndarray:
        return self.residual_of + self.made(float(z[0]))


def slope(_: Saturating, z: np.ndarray, residual: np.ndarray, places: range) -> np.ndarray:
    return np.array([[200.0 / (1.0 + 5.0 * float(z[0])) ** 2]])


def test_a_small_effect_is_found_where_a_line_from_a_larger_one_leads_past_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("doe_kc.discovery.screening.screen.amplitude_columns", slope)
    model: Any = Saturating(true=0.03)
    nothing, jacobian = np.zeros(0), Jacobian(np.zeros((1, 0)))  # no parameter to project out
    found: Any = SimpleNamespace(
        z=model.z,
        residual=model.residual_of,
        remainder=changes(jacobian, model.residual_of, is_residual=True),
        misfit_left=float(model.residual_of @ model.residual_of),
        changes=lambda rows: changes(jacobian, rows),
        projection=Projection(jacobian, nothing, nothing, nothing.astype(int), np.zeros((0, 0))),
    )
    unsolved = amplitude_solution(model, found, np.array([PROBE]), np.array([PROBE]))
    assert not unsolved.solved
    followed = amplitude_solution(model, found, np.array([PROBE]), np.array([PROBE_FACTOR * PROBE]))
    assert followed.solved
    assert followed.amplitudes == pytest.approx([0.03], abs=1e-3)


def test_what_is_left_of_a_large_change_is_trusted_where_bounds_leave_it() -> None:
    assert trusted_detectability(visible=8.0, before=100.0, by_bounds=0.0) == 8.0
    assert trusted_detectability(visible=6.0, before=100.0, by_bounds=1.0) == 1.0
    assert trusted_detectability(visible=16.0, before=300.0, by_bounds=15.9) == 15.9


def test_every_change_is_told_in_units_of_other_errors(monkeypatch: pytest.MonkeyPatch) -> None:
    """A few at a time, the last part fewer: all of them, in their order."""
    search = discovery("named").search
    before = search.tuned.model.likelihood
    wider = tuple(replace(c, root=(1.0 + 0.1 * i) * c.root) for i, c in enumerate(before.curves))
    after = replace(before, curves=wider)
    monkeypatch.setattr(screen_module, "REWHITENED_TOGETHER", 4)
    known = search.first.screened
    assert len(known) % 4
    units = Rewhitening(before, after)
    for one, other in zip(known, rewhitened_screenings(known, before, after), strict=True):
        assert other.hypothesis == one.hypothesis
        np.testing.assert_allclose(other.change, units(one.change), rtol=1e-12)
        np.testing.assert_allclose(other.bend, units(one.bend), rtol=1e-12)
        np.testing.assert_allclose(other.columns, units(one.columns), rtol=1e-12)
