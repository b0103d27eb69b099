"""How an effect and its place are called in every message, table and picture."""

from __future__ import annotations

from doe_kc.curves import RESPONSE_UNITS, SIDE_WORDS, response_name
from doe_kc.effects._base import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.effects.rubber_hysteresis import REAR, REST
from doe_kc.load_cases import LOAD_CASES, case_label

GROUP_WORDS = {REST: f"all bushings but {' and '.join(REAR)}"}


def effect_label(ident: str) -> str:
    """Name of an effect."""
    return EFFECTS[ident].label


def place_of(hypothesis: Hypothesis) -> str:
    """Where or how the effect is looked for, empty for one place only."""
    return place_words(hypothesis.name.removeprefix(hypothesis.effect).strip())


def place_words(place: str) -> str:
    """A location as in `Hypothesis.location`: a bushing or joint, a group, a response, a load case."""
    if place in RESPONSE_UNITS:
        return response_name(place)
    if place in LOAD_CASES:
        return case_label(place).lower()
    head, _, side = place.rpartition("_")
    if side in SIDE_WORDS:
        return f"{head.replace('_', ' ')} {SIDE_WORDS[side]}"
    return GROUP_WORDS.get(place, place.replace("_", " "))


def hypothesis_label(hypothesis: Hypothesis) -> str:
    """Name and place, e.g. `Bushing preload, LLR`."""
    place = place_of(hypothesis)
    return f"{effect_label(hypothesis.effect)}, {place}" if place else effect_label(hypothesis.effect)


def hypothesis_words(hypothesis: Hypothesis) -> str:
    """Name and place within a sentence, e.g. `bushing preload, LLR`."""
    label = hypothesis_label(hypothesis)
    return label[0].lower() + label[1:]
