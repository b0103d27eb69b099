"""The law of a friction: opened where noise does not explain what remains, left alone where it does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest

import doe_kc.discovery.search.laws as laws_module
from doe_kc.axle.places import places_of
from doe_kc.axle_file import read_axle
from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.laws import (
    open_laws,
    other_laws,
    with_best_laws,
    with_free_laws,
    with_free_shapes,
    with_friction_laws,
    with_law,
)
from doe_kc.discovery.thresholds import BEYOND_DOUBT, FREE_TRAVELS
from doe_kc.effects import EFFECTS
from doe_kc.examples import example_folder
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import discovery, library
from tests.discovery.search.law_answers import CLOSED, Answers, agreeing, beside_a_hub, disagreeing, records


def test_a_law_has_its_default_numbers_and_its_own_at_typical() -> None:
    found = agreeing()
    (friction,) = found.model.members
    first, *_ = open_laws(friction)
    assert first.law and len(first.sizes) > len(friction.sizes)
    assert first.name == friction.name
    model, z = with_law(found, friction, first)
    assert model.members == (first,)
    np.testing.assert_array_equal(z[: found.z.size], found.z)
    assert not z[found.z.size :].any()
    assert not open_laws(library("steer_arm_compliance")[0])


def test_other_laws_are_those_of_one_number_more_at_most() -> None:
    (friction,) = agreeing().model.members
    assert [law.law for law in other_laws(friction)] == ["iwan", "duhem", "lognormal"]
    assert [law.law for law in other_laws(open_laws(friction)[0])] == ["", "iwan", "lognormal"]
    assert not other_laws(library("hub_compliance")[0]), "of two numbers more"


def test_rubber_is_opened_to_each_bushing_of_its_own_group() -> None:
    axle = read_axle(example_folder("five_link_rear") / "axle.toml")
    (rubber, *_) = EFFECTS["rubber_hysteresis"].hypotheses(places_of(axle))
    (each,) = open_laws(rubber)
    assert each.law == "each" and each.fixed == rubber.fixed
    assert len(each.sizes) == len(rubber.sizes) + 2 * len(rubber.fixed["bushings"])
    assert not open_laws(each) and not other_laws(rubber)
    (alone,) = [h for h in library("rubber_hysteresis") if h.location == "LLR"]
    assert not open_laws(alone)


@pytest.mark.parametrize(("share", "opened"), [(0.1, True), (0.0, False)])
def test_a_friction_whose_law_has_a_discrepancy_gets_the_best_law(
    share: float, opened: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A friction of two stages, 268 N, had been 211 +- 7 N by Dahl's law: with its discrepancy noise explains
    what that leaves, and to the records' own errors it does not."""
    explained, own, asked = agreeing(), records(), Answers(0.0, best="duhem")
    monkeypatch.setattr(laws_module, "fit_to_errors", lambda f, e, _: disagreeing() if e is own else f)
    (friction,) = explained.model.members
    found = with_friction_laws(explained, own, {friction.name: share}, asked)
    assert (found.model.members[0].law == "duhem") is opened
    assert (found is explained) is not opened
    assert asked.laws[: len(CLOSED)] == (CLOSED if opened else [])


def test_a_friction_whose_shape_sizes_wait_for_is_asked_for_closed_laws_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    current, asked = beside_a_hub(), Answers(50.0)
    remains = current.residual.copy()
    remains[:60] += 5.0
    monkeypatch.setattr(laws_module, "fit_to_errors", lambda f, *_: replace(f, residual=remains))
    found = with_friction_laws(current, records(), {h.name: 0.1 for h in current.model.members}, asked)
    assert found is current and asked.laws == CLOSED


@pytest.mark.parametrize(("cost", "opened"), [(-50.0, True), (10.0, False)])
def test_a_free_law_is_taken_only_where_it_gains(cost: float, opened: bool) -> None:
    asked = Answers(cost)
    found = with_free_laws(disagreeing(), records(), asked)
    free = ["backbone"] * (1 + len(FREE_TRAVELS))
    assert asked.laws == [*CLOSED, *free]
    assert bool(found.model.members[0].law) is opened


def test_a_closed_law_that_explains_comes_before_a_free_one() -> None:
    """A free shape of a strut friction by Prandtl-Iwan's law had 26 to 81 of ln evidence less than that law,
    and kept other effects out."""
    explained = agreeing()

    class Right(Answers):
        def _fit(self, model: EffectModel, z: FloatArray, near: Fit, cost: float) -> Fit:
            fit = super()._fit(model, z, near, cost)
            (law,) = [h.law for h in model.members]
            return replace(fit, residual=explained.residual) if law == self.best else fit

    asked = Right(10.0, best="iwan")
    found = with_free_laws(disagreeing(), records(), asked)
    assert asked.laws == CLOSED and found.model.members[0].law == "iwan"


def test_a_free_law_begins_from_the_best_closed_one() -> None:
    starts: list[tuple[str, str]] = []

    class Asked(Answers):
        def _fit(self, model: EffectModel, z: FloatArray, near: Fit, cost: float) -> Fit:
            starts.append((near.model.members[0].law, model.members[0].law))
            return super()._fit(model, z, near, cost)

    found = with_free_laws(disagreeing(), records(), Asked(50.0, best="duhem"))
    assert found.model.members[0].law == "duhem"
    assert starts[:3] == [("", law) for law in CLOSED]
    assert set(starts[3:]) == {("duhem", "backbone")}


def test_a_free_law_is_fitted_to_the_errors_of_the_records_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors that hold the discrepancy of the law before it took another friction for explained."""
    explained, own = agreeing(), records()
    monkeypatch.setattr(laws_module, "fit_to_errors", lambda f, e, _: disagreeing() if e is own else f)
    freed = with_free_laws(explained, own, Answers(-50.0))
    assert freed.model.members[0].law == "backbone"
    assert with_free_laws(explained, own, Answers(10.0)) is explained


@pytest.mark.parametrize("explains", [True, False])
def test_the_law_of_a_compliance_is_taken_only_where_it_explains(explains: bool) -> None:
    """Of three clamps that bent by a law of their own, 4900 to 9400 Nm/deg, two became leads by ours."""
    found = discovery("named").search.with_effects
    (compliance,) = found.model.members
    residual = found.residual.copy()
    residual[:60] += 5.0
    current = replace(found, residual=residual)

    class Bent(Answers):
        def _fit(self, model: EffectModel, z: FloatArray, near: Fit, cost: float) -> Fit:
            fit = super()._fit(model, z, near, cost)
            return replace(fit, residual=found.residual) if explains else fit

    taken = with_free_laws(current, current.model.likelihood, Bent(-50.0))
    assert taken.model.members[0].name == compliance.name
    assert (taken.model.members[0].law == "stiffening") is explains
    assert explains or taken is current


@pytest.mark.parametrize("best", [1.0, *FREE_TRAVELS])
def test_a_free_backbone_that_leaves_something_begins_from_other_travels(best: float) -> None:
    """A friction of two stages, 225 N, stayed 160 of ln evidence behind by the travel of the closed law."""
    (friction,) = agreeing().model.members
    size = next(i for i, s in enumerate(friction.sizes) if s.key == "presliding_mm")

    class Travels(Answers):
        tried: ClassVar[list[float]] = []

        def _fit(self, model: EffectModel, z: FloatArray, found: Fit, cost: float) -> Fit:
            (place,) = [p for _, p in model.places()]
            was = next(p for _, p in found.model.places()).start + size
            factor = float(np.exp(friction.sizes[size].log_sd * (z[place.start + size] - found.z[was])))
            self.tried.append(factor)
            free = model.members[0].law == "backbone"
            better = 100.0 if free and abs(factor - best) < 1e-9 else 0.0 if free else -200.0
            return super()._fit(model, z, found, cost - better)

    asked = Travels(-50.0)
    found = with_free_laws(disagreeing(), records(), asked)
    assert asked.laws == [*CLOSED, *["backbone"] * (1 + len(FREE_TRAVELS))]
    np.testing.assert_allclose(asked.tried[len(CLOSED) :], [1.0, *FREE_TRAVELS])
    assert found.cost == pytest.approx(disagreeing().cost - 150.0)
    asked.laws.clear()
    explained = agreeing()
    assert with_free_laws(explained, records(), asked) is explained and not asked.laws


@pytest.mark.parametrize(("cost", "free"), [(-50.0, True), (19.0, True), (21.0, False)])
def test_beside_another_effect_a_friction_gets_a_free_shape_unless_that_fits_worse(
    cost: float, free: bool
) -> None:
    closed = beside_a_hub()
    found, other = with_free_shapes(closed, Answers(cost))
    assert other is (closed if free else None)
    friction, hub = found.model.members
    assert friction.law == (open_laws(agreeing().model.members[0])[-1].law if free else "")
    assert hub == library("hub_compliance")[0]


@pytest.mark.parametrize(("first", "tried"), [(-5.0, 1), (5.0, 1 + len(FREE_TRAVELS))])
def test_a_free_shape_that_ends_above_the_closed_law_begins_from_other_travels(
    first: float, tried: int
) -> None:
    """Two frictions and rubber: 2 of cost above, and 17 below from 1.4 of the travel."""
    closed = beside_a_hub()

    class Rough(Answers):
        def _fit(self, model: EffectModel, z: FloatArray, found: Fit, cost: float) -> Fit:
            return super()._fit(model, z, found, first if len(self.laws) == 1 else -8.0 * len(self.laws))

    asked = Rough(0.0)
    found, _ = with_free_shapes(closed, asked)
    assert asked.laws == ["backbone"] * tried
    assert found.cost == pytest.approx(closed.cost + (first if tried == 1 else -8.0 * tried))


def test_a_free_shape_that_leaves_what_the_closed_law_explains_only_widens_sizes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of the same cost as Iwan's law, one left a contrast of 6.6 standard deviations."""

    def chance(fit: Fit) -> SimpleNamespace:
        free = any(h.law == "backbone" for h in fit.model.members)
        return SimpleNamespace(chance=0.0 if free else 0.5)

    monkeypatch.setattr(Fit, "residual_map", property(chance))
    closed, asked = beside_a_hub(), Answers(-5.0)
    found, other = with_free_shapes(closed, asked)
    assert found is closed and asked.laws == ["backbone"] * (1 + len(FREE_TRAVELS))
    assert other is not None and other.model.members[0].law == "backbone"
    monkeypatch.setattr(Fit, "residual_map", property(lambda fit: SimpleNamespace(chance=0.0)))
    found, other = with_free_shapes(closed, Answers(-5.0))
    assert found.model.members[0].law == "backbone" and other is closed


@pytest.mark.parametrize(("cost", "law"), [(10.0, "iwan"), (110.0, "")])
def test_beside_another_effect_a_friction_gets_the_law_of_most_evidence(cost: float, law: str) -> None:
    """A friction of 208 N and a mount of 3275 N/mm were 320 +- 9 and 2178 +- 47 by the free shape that began
    at another law than the car's, with 20 of ln evidence less than that law."""
    asked = Answers(cost, best="iwan")
    friction, _ = with_best_laws(beside_a_hub(), asked).model.members
    assert asked.laws == ["iwan", "duhem", "lognormal"]
    assert friction.law == law


def test_another_closed_law_is_given_up_only_beyond_doubt() -> None:
    """Iwan's law, 46 of cost better than Dahl's, had been given up on the way there."""

    class Ceilings(Answers):
        most: ClassVar[list[float]] = []

        def fits(self, starts: Sequence[FitStart], *told: Any, **options: Any) -> list[Fit | None]:
            self.most.extend(start.ceiling for start in starts)
            return super().fits(starts, *told, **options)

    asked = Ceilings(0.0)
    with_best_laws(beside_a_hub(), asked)
    assert asked.most == [pytest.approx(beside_a_hub().cost + 2.0 * BEYOND_DOUBT)] * 3


@pytest.mark.parametrize(("cost", "law"), [(-5.0, "iwan"), (5.0, "")])
def test_a_friction_that_is_a_trace_gets_no_law_of_more_numbers(cost: float, law: str) -> None:
    """The sizes of the others hang little on a few newtons: 24 s of refits, and 60 MB of derivatives."""
    found, asked = beside_a_hub(), Answers(cost)
    place = next(p for h, p in found.model.places() if open_laws(h))
    z = found.z.copy()
    z[place.start] = 0.05
    trace = replace(found, z=z)
    friction, _ = with_best_laws(trace, asked).model.members
    assert asked.laws == ["iwan"] and friction.law == law
    assert with_free_shapes(trace, asked) == (trace, None)
    assert asked.laws == ["iwan"]


def test_a_friction_alone_keeps_its_law() -> None:
    asked = Answers(-50.0)
    assert with_best_laws(agreeing(), asked).model.members == agreeing().model.members
    assert with_free_shapes(agreeing(), asked)[0].model.members == agreeing().model.members
    assert asked.laws == []


def rubber_alone() -> Fit:
    """Rubber of no size, which moves nothing."""
    rubber = EFFECTS["rubber_hysteresis"].hypotheses()[0]
    found, count = agreeing(), len(rubber.sizes)
    (friction,) = found.model.members
    model = found.model.with_member(friction, rubber)
    rest = found.z.size - len(friction.sizes)
    own = np.hstack([found.jacobian.own[:, : -len(friction.sizes)], np.zeros((found.residual.size, count))])
    z = np.append(found.z[:rest], np.zeros(count))
    return replace(found, model=model, z=z, jacobian=model.jacobian(own))


def test_rubber_alone_is_estimated_with_bushings_that_differ() -> None:
    """Its share is a mean over them, less sure than if all were alike."""
    asked = Answers(0.0)
    (rubber,) = with_free_shapes(rubber_alone(), asked)[0].model.members
    assert rubber.law == "each" and asked.laws == ["each"]


@pytest.mark.parametrize(("cost", "law"), [(0.0, "iwan"), (150.0, "backbone")])
def test_a_law_of_free_shape_gives_way_to_a_closed_one_of_more_evidence(cost: float, law: str) -> None:
    """It came in while other effects were missing that it had to stand for."""
    asked = Answers(-50.0, best="iwan")
    free, _ = with_free_shapes(beside_a_hub(), asked)
    asked.laws.clear()
    asked.cost = cost
    friction, _ = with_best_laws(free, asked).model.members
    assert asked.laws == ["", *CLOSED] and friction.law == law


def test_the_size_of_an_effect_beside_a_friction_is_estimated_beside_a_free_shape() -> None:
    found = discovery("pair").search
    laws = {h.effect: h.law for h in found.with_effects.model.members}
    assert laws == {"hub_compliance": "", "steering_friction": "backbone"}
    assert not open_laws(found.with_effects.model.members[-1])
    hub = next(h for h in found.with_effects.model.members if h.effect == "hub_compliance")
    sizes, sd = amplitude_estimates(found.with_effects, hub)
    np.testing.assert_array_less(np.abs(sizes - [6000.0 / 4000.0, 9000.0 / 7000.0]), 3.0 * sd)
