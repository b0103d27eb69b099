"""The laws that a member can have, and the model with another one."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.axle.places import places_of
from doe_kc.axle_file import read_axle
from doe_kc.discovery.fit import cost_of
from doe_kc.discovery.search.law_variants import open_laws, other_laws, with_law
from doe_kc.effects import EFFECTS
from doe_kc.examples import example_folder
from tests.discovery.cases import library
from tests.discovery.search.law_answers import agreeing


def test_a_law_has_its_default_numbers_and_its_own_at_typical() -> None:
    found = agreeing()
    (friction,) = found.model.members
    first, *_ = open_laws(friction)
    assert first.law and len(first.sizes) > len(friction.sizes)
    assert first.name == friction.name
    model, z = with_law(found.model, found.z, friction, first)
    assert model.members == (first,)
    np.testing.assert_array_equal(z[: found.z.size], found.z)
    assert not z[found.z.size :].any()
    assert not open_laws(library("steer_arm_compliance")[0])


def test_a_free_backbone_begins_as_the_law_before_it() -> None:
    """At typical shares the fit of a strut friction began 11 000 of cost above the law that it came from."""
    found = agreeing()
    (friction,) = found.model.members
    backbone = open_laws(friction)[-1]
    model, z = with_law(found.model, found.z, friction, backbone)
    closed = friction.options(found.model.sizes_at(found.z, friction))
    free = backbone.options(model.sizes_at(z, backbone))
    alike = EFFECTS[friction.effect].numbers_by("backbone", closed)
    assert set(alike) == {"force_N", "presliding_mm", "shares"}
    assert {key: free[key] for key in alike} == {k: pytest.approx(v) for k, v in alike.items()}
    usual = np.append(found.z, np.zeros(z.size - found.z.size))
    assert cost_of(model, z, model.residual(z)) < cost_of(model, usual, model.residual(usual))
    again, same = with_law(model, z, backbone, backbone)
    assert again.members == model.members
    np.testing.assert_array_equal(same, z)


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
