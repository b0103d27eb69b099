"""The laws that a member of a set can have, and the set with another one of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.model import EffectModel
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.typing import FloatArray


def open_laws(member: Hypothesis) -> list[Hypothesis]:
    """The member by laws with numbers of their own beyond those that it has, fewest first."""
    variants = EFFECTS[member.effect].variants(default_law(member))
    more = [v for v in variants if len(v.sizes) > len(member.sizes)]
    return sorted(more, key=lambda v: len(v.sizes))


def other_laws(member: Hypothesis) -> list[Hypothesis]:
    """The member by every other law of at most one number more than the default one has."""
    default = default_law(member)
    variants = EFFECTS[member.effect].variants(default)
    return [v for v in variants if v.law != member.law and len(v.sizes) <= len(default.sizes) + 1]


def laws_of_no_more_numbers(member: Hypothesis) -> list[Hypothesis]:
    """The member by every other law of no more numbers than its own: those that a trace has."""
    return [law for law in other_laws(member) if len(law.sizes) <= len(member.sizes)]


def default_law(member: Hypothesis) -> Hypothesis:
    """The member by the default law of its effect."""
    return replace(member, law="", sizes=EFFECTS[member.effect].sizes) if member.law else member


def frictions(current: Fit) -> list[Hypothesis]:
    """Members of the set that are frictions."""
    return [h for h in current.model.members if EFFECTS[h.effect].frictional]


def with_law(
    model: EffectModel, z: FloatArray, member: Hypothesis, law: Hypothesis
) -> tuple[EffectModel, FloatArray]:
    """The model with a member by another law, and a point z in it, where the new law does nearly what the old
    one does at a point, as far as the effect can tell; other new numbers are at typical."""
    known = model.sizes_at(z, member)
    alike = EFFECTS[law.effect].numbers_by(law.law, member.options(known))
    own = [amplitude_by(s, alike) if s.key in alike else known.get(s.name, 0.0) for s in law.sizes]
    place = model.place(member)
    return model.with_member(member, law), np.concatenate([z[: place.start], own, z[place.stop :]])


def amplitude_by(size: Size, options: Mapping[str, Any]) -> float:
    """Amplitude of a size at options that have its key."""
    value = options[size.key]
    return size.amplitude(value if size.index is None else value[size.index])
