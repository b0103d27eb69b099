"""What effects and their places are called."""

from __future__ import annotations

import pytest

from doe_kc.axle.places import places_of
from doe_kc.axle_file import read_axle
from doe_kc.axle_types import BUILT_IN
from doe_kc.effects import EFFECTS
from doe_kc.effects.words import hypothesis_label, place_words
from doe_kc.examples import example_folder


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_hypothesis_of_a_type_has_a_name_and_a_label_of_its_own_in_plain_words(name: str) -> None:
    places = places_of(read_axle(example_folder(name) / "axle.toml"))
    hypotheses = [h for effect in EFFECTS.values() for h in effect.hypotheses(places)]
    labels = [hypothesis_label(h) for h in hypotheses]
    assert len(set(labels)) == len({h.name for h in hypotheses}) == len(hypotheses)
    assert not [label for label in labels if any(sign in label for sign in "_[]{}'\"")]


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ("LLR", "LLR"),
        ("ROB_L", "ROB left"),
        ("tyre_load", "tyre load"),
        ("lateral_opposite", "lateral force, opposite"),
        ("REST", "all bushings but LLR"),
    ],
)
def test_places_in_words(place: str, words: str) -> None:
    assert place_words(place) == words
