"""The fit that sizes of effects are told of, with the errors and the scatter that the records show, and what
other laws of the effects would make of the sizes.

Sets are compared under what is assumed of errors and scatter, the same for all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from doe_kc.discovery.fit import Fit, rewhitened_fit
from doe_kc.discovery.gauss_newton import chord_fit
from doe_kc.discovery.gauss_newton import fit as optimum
from doe_kc.discovery.search.law_discrepancy import (
    EffectSignal,
    balanced_correlation,
    effect_signals,
    fit_discrepancy,
)
from doe_kc.discovery.search.search import EffectSearch
from doe_kc.discovery.thresholds import LAW_OPEN
from doe_kc.discovery.verdict.own_scatter import with_own_scatter
from doe_kc.discovery.verdict.systematic_errors import systematic_scales, with_systematic_errors
from doe_kc.ground.typing import FloatArray

MODES = 4
"""Shapes of a discrepancy over the input that hold 99 % of its square."""
GRID = np.linspace(-1.0, 1.0, 41)
"""Inputs over the amplitude that they are given at."""


@dataclass(frozen=True)
class SizeFit:
    """The last set's fit with this rig's own errors and this car's own scatter."""

    fit: Fit
    """Its amplitudes are the sizes."""
    law_shifts: FloatArray
    """(d + m, k) by how much the unknowns shift for each shape that the law of a member may have besides,
    one standard deviation of it."""

    def law_sd(self, place: slice) -> FloatArray:
        """(s,) standard deviations of a member's sizes by the laws of all members."""
        return np.asarray(np.linalg.norm(self.law_shifts[place], axis=1))


def size_fit(search: EffectSearch) -> SizeFit:
    """The fit that sizes of the last set are told of.

    What an effect's law leaves is smaller than wide errors hide and larger than narrow ones, so that the
    shares of the discrepancies are raised anew. Derivatives of the last fit lead to it but where sizes and
    factors of theirs trade places, as with rubber: a share of 0.12 was told as 0.08.
    """
    last, exact = search.with_law_discrepancy, search.with_effects
    signals, scales = effect_signals(exact), systematic_scales(last)
    own = last.model.with_likelihood(with_systematic_errors(exact.model.likelihood, scales))
    settled, shares = fit_discrepancy(rewhitened_fit(last, own), signals)
    own_fit = with_own_scatter(chord_fit(settled, settled.model))
    if not own_fit.converged:
        own_fit = optimum(own_fit.model, own_fit.z)
    return SizeFit(own_fit, law_shifts(own_fit, signals, shares))


def law_shifts(fit: Fit, signals: Sequence[EffectSignal], shares: Mapping[str, float]) -> FloatArray:
    """(d + m, k) see `SizeFit`, of the elastic members of a fit; signals: one a member.

    The law is the member's own and the same in every curve: errors curve by curve let it be hidden by what
    tells the curves apart. A mount that stiffens by 12 % made a hub beside it 4 standard deviations softer.
    A compliance's law is open by `LAW_OPEN` at least.
    """
    changes: list[FloatArray] = []
    modes = _modes()
    for member, signal in zip(fit.model.members, signals, strict=True):
        compliant = any(s.growth == "compliance" for s in member.sizes)
        share = max(shares[member.name], LAW_OPEN * compliant)
        if share and not signal.friction:
            changes += [_bent(fit, signal, share * mode) for mode in modes]
    if not changes:
        return np.zeros((fit.z.size, 0))
    return np.asarray(fit.covariance @ fit.jacobian.pulled(np.array(changes).T))


def _bent(fit: Fit, signal: EffectSignal, mode: FloatArray) -> FloatArray:
    """(M,) change of the residual where a member's law is another by a mode (41,) at GRID, in relation."""
    out = np.zeros(fit.residual.size)
    for (curve, at), change in zip(fit.model.likelihood.slices(), signal.changes, strict=True):
        out[at] = curve.whitened(change * np.interp(curve.input / np.abs(curve.input).max(), GRID, mode))
    return np.where(fit.model.used, out, 0.0)


def _modes() -> FloatArray:
    """(MODES, 41) independent shapes of a smooth discrepancy without a mean, at GRID, each in its standard
    deviation."""
    squares, shapes = np.linalg.eigh(balanced_correlation(GRID))
    return np.asarray((np.sqrt(squares[-MODES:]) * shapes[:, -MODES:]).T)
