"""Frictions of free shape: where sizes hang on the law, unless they fit worse or leave more."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.free_shapes import with_free_shapes, with_unlike_bushings
from doe_kc.discovery.search.law_variants import open_laws
from doe_kc.discovery.thresholds import FREE_TRAVELS
from doe_kc.ground.typing import FloatArray
from tests.discovery.cases import discovery, library
from tests.discovery.search.law_answers import Answers, agreeing, beside_a_hub, rubber_alone


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


def test_rubber_alone_is_estimated_with_bushings_that_differ() -> None:
    """Its share is a mean over them, less sure than if all were alike."""
    asked = Answers(0.0)
    (rubber,) = with_free_shapes(rubber_alone(), asked)[0].model.members
    assert rubber.law == "each" and asked.laws == ["each"]


@pytest.mark.parametrize(("cost", "law"), [(19.0, "each"), (21.0, "")])
def test_bushings_are_unlike_beside_dry_frictions_as_they_are(cost: float, law: str) -> None:
    asked = Answers(cost)
    (rubber,) = with_unlike_bushings(rubber_alone(), asked).model.members
    assert rubber.law == law and asked.laws == ["each"]
    friction = beside_a_hub()
    assert with_unlike_bushings(friction, asked) is friction and asked.laws == ["each"]


def test_the_size_of_an_effect_beside_a_friction_is_estimated_beside_a_free_shape() -> None:
    found = discovery("pair").search
    laws = {h.effect: h.law for h in found.with_effects.model.members}
    assert laws == {"hub_compliance": "", "steering_friction": "backbone"}
    assert not open_laws(found.with_effects.model.members[-1])
    hub = next(h for h in found.with_effects.model.members if h.effect == "hub_compliance")
    sizes, sd = amplitude_estimates(found.with_effects, hub)
    np.testing.assert_array_less(np.abs(sizes - [6000.0 / 4000.0, 9000.0 / 7000.0]), 3.0 * sd)
