"""What sizes of effects are called."""

from __future__ import annotations

import pytest

from doe_kc.axle.places import places_of
from doe_kc.axle_file import read_axle
from doe_kc.axle_types import BUILT_IN
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.examples import example_folder
from doe_kc.reports.discovery.effect_words import size_name


def by_every_law(name: str) -> list[Hypothesis]:
    places = places_of(read_axle(example_folder(name) / "axle.toml"))
    return [v for e in EFFECTS.values() for h in e.hypotheses(places) for v in e.variants(h)]


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_size_of_a_hypothesis_by_every_law_has_a_name_of_its_own_in_plain_words(name: str) -> None:
    for hypothesis in by_every_law(name):
        names = [size_name(size, hypothesis.location) for size in hypothesis.sizes]
        assert len(set(names)) == len(names), hypothesis.name
        assert not [n for n in names if any(sign in n for sign in "_[]{}'\"")], names


def test_axes_are_letters_and_sliders_are_numbered() -> None:
    named = {size_name(s, h.location) for h in by_every_law("mcpherson_front") for s in h.sizes}
    assert {"X", "Y", "Z", "share of slider 1", "share of slider 4", "friction force"} <= named
