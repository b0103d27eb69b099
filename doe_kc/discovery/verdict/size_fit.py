"""The fit that sizes of effects are told of, with the errors and the scatter that the records show, and what
other laws of the effects would make of the sizes.

Sets are compared under what is assumed of errors and scatter, the same for all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from doe_kc.discovery.fit import Fit, amplitude_estimates, rewhitened_fit, size_weights
from doe_kc.discovery.gauss_newton import chord_fit
from doe_kc.discovery.gauss_newton import fit as optimum
from doe_kc.discovery.search.baseline import with_friction_traces
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.law_discrepancy import (
    EffectSignal,
    balanced_correlation,
    effect_signals,
    fit_discrepancy,
)
from doe_kc.discovery.thresholds import LAW_OPEN, LINEAR_TO
from doe_kc.discovery.verdict.own_scatter import with_own_scatter
from doe_kc.discovery.verdict.systematic_errors import systematic_scales, with_systematic_errors
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged

MODES = 4
"""Shapes of a discrepancy over the input that hold 99 % of its square."""
GRID = np.linspace(-1.0, 1.0, 41)
"""Inputs over the amplitude that they are given at."""


@dataclass(frozen=True)
class SizeFit:
    """The last set's fit with this rig's own errors and this car's own scatter."""

    fit: Fit
    """Its amplitudes are the sizes."""
    law_shifts: Mapping[str, FloatArray]
    """Member -> (d + m, k) by how much the unknowns shift for each shape that its law may have besides, one
    standard deviation of it."""

    def law_sd(self, member: Hypothesis) -> FloatArray:
        """(s,) standard deviations of a member's sizes by the laws of all members.

        By its own a stiffness is one number to `LINEAR_TO` at best.
        """
        weights = size_weights(self.fit.model, member)
        sd = {name: np.linalg.norm(weights @ shifts, axis=1) for name, shifts in self.law_shifts.items()}
        amplitudes, _ = amplitude_estimates(self.fit, member)
        one_number = np.where(_compliant(member), LINEAR_TO * np.abs(amplitudes), 0.0)
        sd[member.name] = np.maximum(sd.get(member.name, 0.0), one_number)
        return np.asarray(np.linalg.norm(list(sd.values()), axis=0))


def size_fit(search: EffectSearch, workers: DiscoveryWorkers) -> SizeFit:
    """The fit that sizes of the last set are told of.

    What an effect's law leaves is smaller than wide errors hide and larger than narrow ones, so that the
    shares of the discrepancies are raised anew. Derivatives of the last fit lead to it but where sizes and
    factors of theirs trade places, as with rubber: a share of 0.12 was told as 0.08.
    """
    exact, last = search.with_effects, with_friction_traces(search.with_law_discrepancy, workers)
    signals, scales = effect_signals(exact, workers), systematic_scales(last)
    start = rewhitened_fit(last, with_systematic_errors(exact.model.likelihood, scales))
    del last  # its derivatives: those of candidates are beside them otherwise
    settled, shares = fit_discrepancy(start, signals)
    del start
    own_fit = with_own_scatter(chord_fit(settled, settled.model))
    if not own_fit.converged:
        own_fit = optimum(own_fit.model, own_fit.z)
    return SizeFit(own_fit, law_shifts(own_fit, signals, shares))


def law_shifts(
    fit: Fit, signals: Sequence[EffectSignal], shares: Mapping[str, float]
) -> dict[str, FloatArray]:
    """See `SizeFit`, of the elastic members of a fit; signals: one a member.

    The law is the member's own and the same in every curve: errors curve by curve let it be hidden by what
    tells the curves apart. A mount that stiffens by 12 % made a hub beside it 4 standard deviations softer.
    A compliance's law is open by `LAW_OPEN` at least, of what yields: the gap of a free play has none.
    """
    changes = {
        member.name: _law_changes(fit, member, signal, shares[member.name])
        for member, signal in zip(fit.model.members, signals, strict=True)
        if not signal.friction
    }
    return {name: _shifts(fit, np.concatenate(law)) for name, law in changes.items() if law}


def _shifts(fit: Fit, change: FloatArray) -> FloatArray:
    """(d + m, MODES) shifts of the unknowns by a change (N,) of all curves, bent by every mode."""
    return np.asarray(fit.covariance @ fit.jacobian.pulled(_bent(fit, change)))


def _law_changes(fit: Fit, member: Hypothesis, signal: EffectSignal, share: float) -> list[FloatArray]:
    """Change (n,) of every curve by one standard deviation of a member's law; none where its law fits."""
    compliant = _compliant(member)
    if share >= LAW_OPEN or not compliant.any():
        return [share * change for change in signal.changes] if share else []
    changes = signal.changes
    if not all(size.growth == "compliance" or size.shape for size in member.sizes):
        with suppress(NotConverged):
            changes = _yielding(fit, member, compliant)
    return [LAW_OPEN * change for change in changes]


def _compliant(member: Hypothesis) -> NDArray[np.bool_]:
    """(s,) which sizes of a member are compliances."""
    return np.array([size.growth == "compliance" for size in member.sizes], dtype=bool)


def _yielding(fit: Fit, member: Hypothesis, compliant: NDArray[np.bool_]) -> tuple[FloatArray, ...]:
    """Change (n,) of every curve by those sizes of a member alone. NotConverged without an equilibrium."""
    place = fit.model.place(member)
    rigid = fit.z.copy()
    rigid[place] = np.where(compliant, 0.0, rigid[place])
    yielding = fit.residual - fit.model.residual(rigid)
    return tuple(curve.root @ yielding[at] for curve, at in fit.model.likelihood.slices())


def _bent(fit: Fit, change: FloatArray) -> FloatArray:
    """(M, MODES) changes of the residual where that of all curves (N,) goes by each mode over the input."""
    out, modes = np.zeros((fit.residual.size, MODES)), _modes()
    for group in fit.model.likelihood.groups:
        at = group.first.input / np.abs(group.first.input).max()
        along = np.array([np.interp(at, GRID, mode) for mode in modes]).T
        own = change[group.place].reshape(len(group.curves), at.size, 1) * along
        out[group.place] = group.whitened(own)
    return np.where(fit.model.used[:, None], out, 0.0)


def _modes() -> FloatArray:
    """(MODES, 41) independent shapes of a smooth discrepancy without a mean, at GRID, each in its standard
    deviation."""
    squares, shapes = np.linalg.eigh(balanced_correlation(GRID))
    return np.asarray((np.sqrt(squares[-MODES:]) * shapes[:, -MODES:]).T)
