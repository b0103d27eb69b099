"""Which effects a model can have together."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from doe_kc.curves import SIDES
from doe_kc.discovery.model import EffectModel
from doe_kc.effects.hypothesis import Hypothesis

SEVERAL_PLACES = ("bushing_preload", "bushing_progression", "left_right_asymmetry", "rubber_hysteresis")
"""Effects that a model may have in several places at once."""


def compatible(model: EffectModel, hypothesis: Hypothesis) -> bool:
    """Whether the model can take the effect besides those it has."""
    return all(_beside(member, hypothesis) for member in model.members)


def compatible_set(members: Sequence[Hypothesis]) -> bool:
    """Whether a model can have them all."""
    return all(_beside(one, other) for one, other in combinations(members, 2))


def _beside(one: Hypothesis, other: Hypothesis) -> bool:
    """Whether a model can have both; an effect without a place is in all its places."""
    if one.effect != other.effect:
        return True
    places = {_bushing(one), _bushing(other)}
    return one.effect in SEVERAL_PLACES and len(places) == 2 and "" not in places


def _bushing(hypothesis: Hypothesis) -> str:
    """Its bushing, of either side; empty without a place."""
    location = hypothesis.location or ""
    head, _, side = location.rpartition("_")
    return head if side in SIDES else location
