"""What the laws of the set's members say before a further effect comes in.

An effect that comes in while a law is not the car's may be what that law lacks.
"""

from __future__ import annotations

from collections.abc import Sequence

from doe_kc.correlation.likelihood import Likelihood
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart, refit_to_errors
from doe_kc.discovery.search.convergence import fit_to_errors
from doe_kc.discovery.search.free_shapes import with_most_numbers
from doe_kc.discovery.search.law_discrepancy import effect_signals, fit_discrepancy
from doe_kc.discovery.search.law_variants import frictions, open_laws
from doe_kc.discovery.search.laws import with_best_law
from doe_kc.discovery.search.refits import HypothesisFit
from doe_kc.discovery.thresholds import ACCEPTED_ODDS, FEW_CONTRASTS, NOISE_CHANCE, PROPOSAL_GAIN
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis


def laws_instead(
    current: Fit, further: HypothesisFit, own: Likelihood, workers: DiscoveryWorkers
) -> Fit | None:
    """The fit with the best laws of its frictions, where they say more of the records than a further effect
    would, by the laws that it came in with and by the best ones beside it; else None. own: the records' own
    errors.

    Asked where noise explains what remains, but for single contrasts, as it does once the discrepancy of a
    friction's law is among the errors. An effect that comes in then may be what that law lacks: a steering
    friction of two stages, 383 N, became one of 978 N beside a rack mount of 18 000 N/mm. Beside a mount of
    5780 N/mm that is there, Dahl's law was better than a worse law with it, and 240 N became 185 +- 2 N.
    """
    members = [h for h in frictions(current) if open_laws(h)]
    if not _few_contrasts(current) or not members:
        return None
    exact, rival = fit_to_errors(current, own, workers), refit_to_errors(further.fit, own)
    best = _with_best_laws(exact, members, workers)
    (added,) = workers.fits([FitStart(rival.model, rival.z, rival)], "freeing laws")
    if best is exact or added is None:
        return None if best is exact else best
    if best.evidence > added.evidence + further.prior:
        added = _with_best_laws(added, members, workers)
    return best if best.evidence > added.evidence + further.prior else None


def _with_best_laws(fit: Fit, members: Sequence[Hypothesis], workers: DiscoveryWorkers) -> Fit:
    """The fit with the best law of each of its frictions, one after the other."""
    for member in members:
        fit = with_best_law(fit, member, workers)
    return fit


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
    settled, _ = fit_discrepancy(bent, effect_signals(bent))
    beside = fit_to_errors(both, settled.model.likelihood, workers)
    return beside.evidence + further.prior - settled.evidence <= ACCEPTED_ODDS


def _few_contrasts(current: Fit) -> bool:
    """Whether noise explains what remains, but for single contrasts."""
    left = current.residual_map
    return left.chance >= NOISE_CHANCE or left.mean_square <= FEW_CONTRASTS
