"""The law of an effect is part of the set: a friction by the default law, or by one of open shape.

What a wrong law leaves behind looks like another effect, and hides others. So where noise does not explain
what remains, the law of every friction in the set is opened: by one number at once, wholly where nothing else
explains it.
"""

from __future__ import annotations

import numpy as np

from doe_kc.discovery.fit import Fit, FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import LAW_WINDOW, NOISE_CHANCE
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray


def open_laws(member: Hypothesis) -> list[Hypothesis]:
    """The member by laws with numbers of their own beyond those that it has, fewest first."""
    variants = EFFECTS[member.effect].variants(_default(member))
    more = [v for v in variants if len(v.sizes) > len(member.sizes)]
    return sorted(more, key=lambda v: len(v.sizes))


def other_laws(member: Hypothesis) -> list[Hypothesis]:
    """The member by every other law of at most one number more than the default one has."""
    default = _default(member)
    variants = EFFECTS[member.effect].variants(default)
    return [v for v in variants if v.law != member.law and len(v.sizes) <= len(default.sizes) + 1]


def _default(member: Hypothesis) -> Hypothesis:
    """The member by the default law of its effect."""
    known = EFFECTS[member.effect].hypotheses()
    return next((h for h in known if h.name == member.name), member)


def with_open_laws(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit with laws that have one number more each, as it is where noise explains what remains.

    They go on even with a little less evidence: an effect that is still missing may ask for them.
    """
    for member in current.model.members:
        for law in open_laws(member)[:1] if not member.law else ():
            if len(law.sizes) == len(_default(member).sizes) + 1:
                current = _opened(current, member, law, LAW_WINDOW, workers)
    return current


def with_free_laws(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit with the laws of most numbers that gain evidence, where nothing else explains what remains."""
    for member in current.model.members:
        for law in open_laws(member)[-1:]:
            current = _opened(current, member, law, 0.0, workers)
    return current


def _opened(
    current: Fit, member: Hypothesis, law: Hypothesis, window: float, workers: DiscoveryWorkers
) -> Fit:
    if current.residual_map.chance >= NOISE_CHANCE:
        return current
    model, z = with_law(current, member, law)
    (refit,) = workers.fits([FitStart(model, z, current)], "opening laws")
    if refit is None or refit.evidence < current.evidence - window:
        return current
    return refit


def with_law(current: Fit, member: Hypothesis, law: Hypothesis) -> tuple[EffectModel, FloatArray]:
    """The model with a member by another law, and the fit's point in it; numbers that are new at typical."""
    model = current.model.with_member(member, law)
    known = current.model.sizes_at(current.z, member)
    own = [known.get(s.name, 0.0) for s in law.sizes]
    place = next(p for h, p in current.model.places() if h == member)
    return model, np.concatenate([current.z[: place.start], own, current.z[place.stop :]])
