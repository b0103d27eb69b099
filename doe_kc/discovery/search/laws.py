"""The law of an effect is part of the set: a friction by the default law, or by one of open shape.

What a wrong law leaves behind looks like another effect, and hides others. So where noise does not explain
what remains, the law of every friction in the set is opened: by one number at once, wholly where nothing else
explains it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from doe_kc.discovery.fit import Fit, FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.thresholds import LAW_WINDOW, NOISE_CHANCE
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray

Promise = Callable[[Fit], float]
"""ln posterior odds that further effects promise beside a fit, to first order."""


def open_laws(member: Hypothesis) -> list[Hypothesis]:
    """The member by laws with numbers of their own beyond those that it has, fewest first."""
    more = [v for v in _laws(member) if len(v.sizes) > len(member.sizes)]
    return sorted(more, key=lambda v: len(v.sizes))


def _laws(member: Hypothesis) -> tuple[Hypothesis, ...]:
    """The member by every law of its effect, the default one first."""
    return EFFECTS[member.effect].variants(_default(member))


def _default(member: Hypothesis) -> Hypothesis:
    """The member by the default law of its effect."""
    known = EFFECTS[member.effect].hypotheses()
    return next((h for h in known if h.name == member.name), member)


def with_open_laws(current: Fit, workers: DiscoveryWorkers, promise: Promise) -> Fit:
    """The fit with laws that have one number more at most, as it is where noise explains what remains.

    A law is worth what it explains together with the effects that it asks for: a missing effect bends it.
    They go on even with a little less evidence.
    """
    for member in current.model.members:
        most = len(_default(member).sizes) + 1
        laws = [v for v in _laws(member) if len(v.sizes) <= most and v.law != member.law]
        current = _opened(current, member, laws, LAW_WINDOW, workers, promise)
    return current


def with_free_laws(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit with the laws of most numbers that gain evidence, where nothing else explains what remains."""
    for member in current.model.members:
        current = _opened(current, member, open_laws(member)[-1:], 0.0, workers, lambda _: 0.0)
    return current


def _opened(
    current: Fit,
    member: Hypothesis,
    laws: Sequence[Hypothesis],
    window: float,
    workers: DiscoveryWorkers,
    promise: Promise,
) -> Fit:
    if not laws or current.residual_map.chance >= NOISE_CHANCE:
        return current
    starts = [FitStart(*with_law(current, member, law), current) for law in laws]
    refits = [f for f in workers.fits(starts, "opening laws") if f is not None]
    if not refits:
        return current
    worth = [f.evidence + promise(f) for f in refits]
    best = int(np.argmax(worth))
    return refits[best] if worth[best] >= current.evidence + promise(current) - window else current


def with_law(current: Fit, member: Hypothesis, law: Hypothesis) -> tuple[EffectModel, FloatArray]:
    """The model with a member by another law, and the fit's point in it; numbers that are new at typical."""
    model = current.model.with_member(member, law)
    known = current.model.sizes_at(current.z, member)
    own = [known.get(s.name, 0.0) for s in law.sizes]
    place = next(p for h, p in current.model.places() if h == member)
    return model, np.concatenate([current.z[: place.start], own, current.z[place.stop :]])
