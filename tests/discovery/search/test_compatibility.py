"""Effects that a model can have together."""

from __future__ import annotations

from dataclasses import replace

import pytest

from doe_kc.discovery.search.compatibility import compatible_set
from tests.discovery.cases import library

PRELOAD = library("bushing_preload")[0]


@pytest.mark.parametrize(
    ("one", "other", "together"),
    [
        ("LLF", "LLR", True),
        ("LLF", "LLF_L", False),
        ("LLF_L", "LLF_R", False),
        ("ARM_FRONT", "ARM_REAR", True),
        ("ARM_FRONT_L", "ARM_FRONT_R", False),
        (None, "LLR", False),
    ],
)
def test_one_effect_in_several_bushings(one: str | None, other: str, together: bool) -> None:
    """Names of bushings are the user's own, an underscore among them is no side."""
    places = [replace(PRELOAD, location=location) for location in (one, other)]
    assert compatible_set(places) is together


def test_effects_of_different_kinds_are_compatible() -> None:
    assert compatible_set([PRELOAD, *library("hub_compliance", "strut_friction")])


def test_an_effect_without_places_is_there_once() -> None:
    (hub,) = library("hub_compliance")
    assert not compatible_set([hub, hub])
