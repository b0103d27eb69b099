"""The fit that sizes of effects are told of, with the errors and the scatter that the records show.

Sets are compared under what is assumed of them, the same for all.
"""

from __future__ import annotations

from doe_kc.discovery.fit import Fit, rewhitened_fit
from doe_kc.discovery.gauss_newton import chord_fit
from doe_kc.discovery.own_scatter import with_own_scatter
from doe_kc.discovery.search.law_discrepancy import effect_signals, fit_discrepancy
from doe_kc.discovery.search.search import EffectSearch
from doe_kc.discovery.verdict.systematic_errors import systematic_scales, with_systematic_errors


def size_fit(search: EffectSearch) -> tuple[Fit, dict[str, float]]:
    """The last set's fit with this rig's own errors and this car's own scatter, and the share of each
    member's discrepancy.

    What an effect's law leaves is smaller than wide errors hide and larger than narrow ones, so that the
    shares are raised anew.
    """
    last, exact = search.with_law_discrepancy, search.with_effects
    scales = systematic_scales(last)
    own = last.model.with_likelihood(with_systematic_errors(exact.model.likelihood, scales))
    settled, shares = fit_discrepancy(rewhitened_fit(last, own), effect_signals(exact))
    return with_own_scatter(chord_fit(settled, settled.model)), shares
