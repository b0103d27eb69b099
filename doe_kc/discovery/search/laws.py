"""The law of an effect is part of the set: a friction by the default law, or by one of open shape; a
compliance linear or stiffening.

What a wrong law leaves behind looks like another effect, and hides others; a law of more numbers takes up
what is another effect's. So the law of a friction is exchanged where nothing else explains what remains, or
its own discrepancy alone, and a compliance's where nothing else does.

Which effects are there, laws of few numbers tell as well as any; how large they are, they do not. A motion
that stays in presliding is a spring by the law's shape, and a compliance beside it takes up what that shape
lacks. Closed forms that noise does not tell apart, or nearly so, then give sizes that differ by more than any
of them allows, and their evidence measures which is the least wrong one. So sizes are estimated beside
frictions of free shape, of which closed forms are special cases: the discrepancy of the law at its source,
as numbers of the fit. A friction that is a trace has a closed form.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.convergence import fit_to_errors
from doe_kc.discovery.search.law_discrepancy import effect_signals, fit_discrepancy
from doe_kc.discovery.search.refits import more_than_trace
from doe_kc.discovery.thresholds import BEYOND_DOUBT, FREE_SHAPE_LOSS, FREE_TRAVELS, NOISE_CHANCE
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects._friction import SHARES, TRAVEL
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
    return replace(member, law="", sizes=EFFECTS[member.effect].sizes) if member.law else member


def may_open(current: Fit) -> bool:
    """Whether what remains may be another law of a friction in the set.

    That comes before further effects that nothing points to: a third law of a steering friction looked like a
    compliance of the rack's mount.
    """
    unexplained = current.residual_map.chance < NOISE_CHANCE
    return unexplained and any(open_laws(member) for member in current.model.members)


def with_friction_laws(
    current: Fit, own: Likelihood, shares: Mapping[str, float], workers: DiscoveryWorkers
) -> Fit:
    """The fit with the best laws of the frictions whose law has a discrepancy: closed ones, and free ones of
    those that `with_free_shapes` leaves.

    own: the records' own errors, see `with_free_laws`. shares: member's name -> its law's discrepancy among
    the errors of the fit. Asked once nothing else comes in: a friction of two stages, 268 N, was 211 +- 7 N
    by Dahl's law, whose discrepancy explained what it left. Not before: 489 N beside a mount of the rack of
    3675 N/mm were 234 N by Duhem's law without a mount.
    """
    members = [h for h in frictions(current) if open_laws(h) and shares.get(h.name, 0.0) > 0.0]
    if not members:
        return current
    exact = fit_to_errors(current, own, workers)
    later = {h.name for h in _frictions_to_free(exact)}
    opened = _until_explained(exact, [h for h in members if h.name not in later], workers)
    for member in (h for h in members if h.name in later):
        if opened.residual_map.chance < NOISE_CHANCE:
            opened = _with_closed_law(opened, member, other_laws(member), workers)
    return current if opened is exact else opened


def with_free_laws(current: Fit, own: Likelihood, workers: DiscoveryWorkers) -> Fit:
    """The fit with the laws that gain evidence, closed or free, where nothing else explains what remains.

    own: the records' own errors, to which such a law is fitted: errors that hold the discrepancy of the law
    before it take a poor one for explained. A friction of two stages, 227 N over 0.19 mm, ended at 223 N over
    0.38 mm in them, 20 of ln evidence behind.

    Those of compliances count if they leave nothing that noise and their own discrepancy do not explain. Else
    the discrepancy of the linear law says as much with fewer numbers, and the effect stays named.
    """
    exact = fit_to_errors(current, own, workers)
    opened = _until_explained(exact, [h for h in frictions(exact) if open_laws(h)], workers)
    bent = _bent(opened, workers)
    if bent is not opened and _explained(bent):
        return bent
    return current if opened is exact else opened


def _until_explained(exact: Fit, members: Sequence[Hypothesis], workers: DiscoveryWorkers) -> Fit:
    """The fit with the best law of each of its frictions, one after the other, until noise explains the
    rest."""
    for member in members:
        if exact.residual_map.chance < NOISE_CHANCE:
            exact = with_best_law(exact, member, workers)
    return exact


def with_best_law(current: Fit, member: Hypothesis, workers: DiscoveryWorkers) -> Fit:
    """The fit with the law of most evidence for a friction by a closed law: its own, another closed one, or
    where noise does not explain what those leave a free one, which begins from the best of them.

    A free shape pays for the width of its prior: of a strut friction by Prandtl-Iwan's law it had 26 to 81 of
    ln evidence less than that, and kept other effects out.
    """
    best = _with_closed_law(current, member, other_laws(member), workers)
    if best.residual_map.chance >= NOISE_CHANCE:
        return best
    closed = next(h for h in best.model.members if h.name == member.name)
    free = best_fit(with_most_numbers(best, [closed]), workers)
    return best if free is None or free.evidence <= best.evidence else free


def _bent(current: Fit, workers: DiscoveryWorkers) -> Fit:
    for member in current.model.members:
        for law in open_laws(member)[-1:] if not EFFECTS[member.effect].frictional else ():
            current = _opened(current, member, law, workers)
    return current


def _explained(exact: Fit) -> bool:
    """Whether noise and the discrepancy of its laws explain what a fit to the records' own errors leaves."""
    settled, _ = fit_discrepancy(exact, effect_signals(exact))
    return settled.residual_map.chance >= NOISE_CHANCE


def with_best_laws(current: Fit, workers: DiscoveryWorkers) -> Fit:
    """The fit with the closed law of most evidence for every friction on which other sizes may hang.

    The free shape begins from it, and does not find back from a wrong one: its sliders make the cost rough.
    A trace has the laws of no more numbers to choose from: 5 N in a strut by Dahl's law where Prandtl-Iwan's
    is the car's left 0.7 standard deviations in a tyre's compliance.
    """
    free = _frictions_to_free(current)
    others = any(h not in frictions(current) for h in current.model.members)
    for member in frictions(current):
        laws = other_laws(member)
        if member not in free:
            laws = [law for law in laws if others and len(law.sizes) <= len(member.sizes)]
        current = _with_closed_law(current, member, laws, workers)
    return current


def _with_closed_law(
    current: Fit, member: Hypothesis, laws: Sequence[Hypothesis], workers: DiscoveryWorkers
) -> Fit:
    # from the numbers of another law a fit promises little at first: one given up 40 of cost behind Dahl's
    # was 46 better at its end, and a hub's stiffness beside Dahl's 5309 +- 719 for 13 900
    most = current.cost + 2.0 * BEYOND_DOUBT
    starts = [FitStart(*with_law(current, member, law), current, most) for law in laws]
    refits = [f for f in workers.fits(starts, "exchanging laws") if f is not None]
    return max([current, *refits], key=lambda f: f.evidence)


def with_free_shapes(current: Fit, workers: DiscoveryWorkers) -> tuple[Fit, Fit | None]:
    """The fit with every friction by the law of most numbers, where sizes may hang on it; and the other one
    of both, None where no such law fits as well.

    Its evidence is not asked: what a law of free shape loses is the width of its prior. Where it fits worse,
    as a law with drifting loops could make it, the fit stays as it is. It begins from other travels too where
    the first ends above the closed law, which it could all but follow: on a car with two frictions and rubber
    that left a contrast of 4.3 standard deviations, and 10 of ln likelihood. Nor is it taken where it leaves
    what the closed law explains: one of the same cost left a contrast of 6.6.
    """
    start = with_most_numbers(current, _frictions_to_free(current))
    if start.model is current.model:
        return current, None
    explained = current.residual_map.chance >= NOISE_CHANCE

    def explains(refit: Fit) -> bool:
        return not explained or refit.residual_map.chance >= NOISE_CHANCE

    refits = workers.fits(
        [start, *_other_travels(start)],
        "opening laws",
        enough=lambda refit: refit is not None and refit.cost <= current.cost and explains(refit),
    )
    near = [f for f in refits if f is not None and f.cost <= current.cost + 2.0 * FREE_SHAPE_LOSS]
    if not near:
        return current, None
    best = min(near, key=lambda f: (not explains(f), f.cost))
    return (best, current) if explains(best) else (current, best)


def with_most_numbers(current: Fit, members: Sequence[Hypothesis]) -> FitStart:
    """Where a fit with the law of most numbers for some members begins."""
    model, z = current.model, current.z
    for member in members:
        for law in open_laws(member)[-1:]:
            model, z = _replaced(model, z, member, law)
    return FitStart(model, z, current)


def _frictions_to_free(current: Fit) -> list[Hypothesis]:
    """Frictions of the set on whose law sizes hang: all that are more than traces where it has other effects
    of the car too, else rubber alone, whose share is a mean of bushings that differ."""
    free = [h for h in frictions(current) if len(EFFECTS[h.effect].variants(_default(h))) > 1]
    others = [h for h in current.model.members if h not in free and not EFFECTS[h.effect].on_rig]
    if not others:
        return [h for h in free if not EFFECTS[h.effect].laws]
    return [h for h in free if _more_than_trace(current, h)]


def frictions(current: Fit) -> list[Hypothesis]:
    """Members of the set that are frictions."""
    return [h for h in current.model.members if EFFECTS[h.effect].frictional]


def _more_than_trace(current: Fit, member: Hypothesis) -> bool:
    amplitudes, sds = amplitude_estimates(current, member)
    numbers = zip(member.sizes, np.abs(amplitudes).tolist(), sds.tolist(), strict=True)
    return more_than_trace([(size, a, sd) for size, a, sd in numbers if not size.shape])


def _opened(current: Fit, member: Hypothesis, law: Hypothesis, workers: DiscoveryWorkers) -> Fit:
    if current.residual_map.chance >= NOISE_CHANCE:
        return current
    refit = best_fit(FitStart(*with_law(current, member, law), current), workers)
    if refit is None or refit.evidence < current.evidence:
        return current
    return refit


def best_fit(start: FitStart, workers: DiscoveryWorkers) -> Fit | None:
    """The fit with an opened law; where noise does not explain what it leaves, the best of several starts.

    The sliders of a free backbone make the cost rough. From Duhem's law, 235 N over 0.81 mm, a friction of
    two stages ended 160 of ln evidence behind the fit from 0.7 of that travel: 224.7 N over 0.38 mm, the
    car's.
    """
    fits = workers.fits(
        [start, *_other_travels(start)],
        "opening laws",
        enough=lambda refit: refit is not None and refit.residual_map.chance >= NOISE_CHANCE,
    )
    return max((f for f in fits if f is not None), key=lambda f: f.evidence, default=None)


def _other_travels(start: FitStart) -> list[FitStart]:
    """The same start with other travels of the frictions of free shape; none without one."""
    places = [
        (place.start + i, size.log_sd)
        for h, place in start.model.places()
        if any(size.key == SHARES for size in h.sizes)
        for i, size in enumerate(h.sizes)
        if size.key == TRAVEL
    ]
    out = []
    for factor in FREE_TRAVELS if places else ():
        z = start.z.copy()
        for place, log_sd in places:
            z[place] += np.log(factor) / log_sd
        out.append(replace(start, z=z))
    return out


def with_law(current: Fit, member: Hypothesis, law: Hypothesis) -> tuple[EffectModel, FloatArray]:
    """The model with a member by another law, and the fit's point in it; numbers that are new at typical."""
    return _replaced(current.model, current.z, member, law)


def _replaced(
    model: EffectModel, z: FloatArray, member: Hypothesis, law: Hypothesis
) -> tuple[EffectModel, FloatArray]:
    known = model.sizes_at(z, member)
    own = [known.get(s.name, 0.0) for s in law.sizes]
    place = next(p for h, p in model.places() if h == member)
    return model.with_member(member, law), np.concatenate([z[: place.start], own, z[place.stop :]])
