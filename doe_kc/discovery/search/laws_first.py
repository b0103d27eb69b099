"""What the laws of the set's members say before a further effect comes in.

An effect that comes in while a law is not the car's may be what that law lacks.
"""

from __future__ import annotations

import numpy as np

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, refit_to_errors
from doe_kc.discovery.search.convergence import fit_to_errors
from doe_kc.discovery.search.free_shapes import with_most_numbers
from doe_kc.discovery.search.law_discrepancy import effect_signals, fit_discrepancy
from doe_kc.discovery.search.law_variants import frictions, open_laws, other_laws, with_law
from doe_kc.discovery.search.laws import with_best_law
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.thresholds import (
    ACCEPTED_ODDS,
    BEYOND_DOUBT,
    FEW_CONTRASTS,
    NOISE_CHANCE,
    PROPOSAL_GAIN,
)
from doe_kc.discovery.workers import DiscoveryWorkers

Laws = tuple[tuple[str, str], ...]
"""Name and law of each member."""


def laws_of(current: Fit) -> Laws:
    """Of a set."""
    return tuple((h.name, h.law) for h in current.model.members)


def laws_instead(
    current: Fit, further: HypothesisFit, own: Likelihood, workers: DiscoveryWorkers
) -> Fit | None:
    """The fit with the best laws of its frictions, where they say more of the records than a further effect
    beside the laws that it came in with: without the effect, or with it where it says something beside them
    too; else None. own: the records' own errors.

    Asked where noise explains what remains, but for single contrasts, as it does once the discrepancy of a
    friction's law is among the errors. An effect that comes in then may be what that law lacks: a steering
    friction of two stages, 383 N, became one of 978 N beside a rack mount of 18 000 N/mm. Beside a mount of
    5780 N/mm that is there, Dahl's law was better than a worse law with it, and 240 N became 185 +- 2 N. Four
    effects came in beside Dahl's law where Prandtl-Iwan's had 400 of ln evidence more in every step.
    """
    members = [h for h in frictions(current) if open_laws(h)]
    if not _few_contrasts(current) or not members:
        return None
    exact, rival = fit_to_errors(current, own, workers), refit_to_errors(further.fit, own)
    (added,) = workers.fits([FitStart(rival.model, rival.z, rival)], "freeing laws")
    del rival  # its derivatives
    best, useful = exact, np.inf if added is None else _useful_cost(exact, added.evidence + further.prior)
    for member in members:
        best = with_best_law(best, member, workers, useful)
    if best is exact or added is None:
        return None if best is exact else best
    if best.evidence <= added.evidence + further.prior:
        return None
    beside = [fit for fit in workers.fits(_by_laws_of(best, added), "exchanging laws") if fit is not None]
    both = max(beside, key=lambda fit: fit.evidence, default=added)
    if best.evidence > both.evidence + further.prior:
        return best
    return both if both.evidence - added.evidence > ACCEPTED_ODDS else None


def _useful_cost(exact: Fit, evidence: float) -> float:
    """Largest cost with which the same set by other laws need be fitted to its end for an evidence."""
    return exact.cost - 2.0 * (evidence - exact.evidence) + 2.0 * BEYOND_DOUBT


def _by_laws_of(best: Fit, added: Fit) -> list[FitStart]:
    """Starts of the set of `added` by the laws of `best`, free shapes where noise does not explain what it
    leaves: from either fit's numbers."""
    laws = {h.name: h for h in best.model.members}
    explained = added.residual_map.chance >= NOISE_CHANCE
    model, z = added.model, added.z
    for member in added.model.members:
        law = laws.get(member.name, member)
        if law.law != member.law and (not explained or law in other_laws(member)):
            model, z = with_law(model, z, member, law)
    if model is added.model:
        return []
    known = {(h.name, h.law): best.z[place] for h, place in best.model.places()}
    sizes = [known.get((h.name, h.law), z[place]) for h, place in model.places()]
    fixed = best.model.dimension
    return [FitStart(model, z, added), FitStart(model, np.concatenate([best.z[:fixed], *sizes]), best)]


def needless_beside_laws(
    current: Fit, further: HypothesisFit, own: Likelihood, workers: DiscoveryWorkers
) -> bool:
    """Whether a weak further effect brings nothing beside the laws of most numbers of the set's compliances,
    which say more of the records than it. own: the records' own errors. Asked as `laws_instead`.

    A clamp of 4000 Nm/deg that softened by a law of its own took a rack mount of 5700 N/mm into its set: 60
    of ln evidence in the records' own errors, where the law of the clamp had 840, and nothing beside it.
    """
    bending = [h for h in current.model.members if h not in frictions(current) and open_laws(h)]
    if not _few_contrasts(current) or not bending or further.gain >= PROPOSAL_GAIN:
        return False
    exact, rival = (fit_to_errors(fit, own, workers) for fit in (current, further.fit))
    starts = [with_most_numbers(fit, bending) for fit in (exact, rival)]
    bent, both = workers.fits(starts, "freeing laws")
    if bent is None or both is None or bent.evidence <= rival.evidence + further.prior:
        return False
    del exact, rival, starts  # the derivatives of six fits are 100 MB
    settled, _ = fit_discrepancy(bent, effect_signals(bent, workers))
    del bent
    beside = fit_to_errors(both, settled.model.likelihood, workers)
    return beside.evidence + further.prior - settled.evidence <= ACCEPTED_ODDS


def _few_contrasts(current: Fit) -> bool:
    """Whether noise explains what remains, but for single contrasts."""
    left = current.residual_map
    return left.chance >= NOISE_CHANCE or left.mean_square <= FEW_CONTRASTS
