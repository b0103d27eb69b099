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

from doe_kc.discovery.fit import Fit, rewhitened_fit, size_weights
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
from doe_kc.discovery.thresholds import LAW_OPEN
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
    law_shifts: FloatArray
    """(d + m, k) by how much the unknowns shift for each shape that the law of a member may have besides,
    one standard deviation of it."""

    def law_sd(self, member: Hypothesis) -> FloatArray:
        """(s,) standard deviations of a member's sizes by the laws of all members."""
        shifts = size_weights(self.fit.model, member) @ self.law_shifts
        return np.asarray(np.linalg.norm(shifts, axis=1))


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


def law_shifts(fit: Fit, signals: Sequence[EffectSignal], shares: Mapping[str, float]) -> FloatArray:
    """(d + m, k) see `SizeFit`, of the elastic members of a fit; signals: one a member.

    The law is the member's own and the same in every curve: errors curve by curve let it be hidden by what
    tells the curves apart. A mount that stiffens by 12 % made a hub beside it 4 standard deviations softer.
    A compliance's law is open by `LAW_OPEN` at least, of what yields: the gap of a free play has none.
    """
    changes = [
        _law_changes(fit, member, signal, shares[member.name])
        for member, signal in zip(fit.model.members, signals, strict=True)
        if not signal.friction
    ]
    return _shifts(fit, [np.concatenate(law) for law in changes if law])


def _shifts(fit: Fit, changes: Sequence[FloatArray]) -> FloatArray:
    """(d + m, MODES k) shifts of the unknowns by k changes (N,) of all curves, each bent by every mode."""
    if not changes:
        return np.zeros((fit.z.size, 0))
    return np.asarray(fit.covariance @ fit.jacobian.pulled(_bent(fit, np.array(changes).T)))


def _law_changes(fit: Fit, member: Hypothesis, signal: EffectSignal, share: float) -> list[FloatArray]:
    """Change (n,) of every curve by one standard deviation of a member's law; none where its law fits."""
    compliant = np.array([size.growth == "compliance" for size in member.sizes], dtype=bool)
    if share >= LAW_OPEN or not compliant.any():
        return [share * change for change in signal.changes] if share else []
    changes = signal.changes
    if not all(size.growth == "compliance" or size.shape for size in member.sizes):
        with suppress(NotConverged):
            changes = _yielding(fit, member, compliant)
    return [LAW_OPEN * change for change in changes]


def _yielding(fit: Fit, member: Hypothesis, compliant: NDArray[np.bool_]) -> tuple[FloatArray, ...]:
    """Change (n,) of every curve by those sizes of a member alone. NotConverged without an equilibrium."""
    place = fit.model.place(member)
    rigid = fit.z.copy()
    rigid[place] = np.where(compliant, 0.0, rigid[place])
    yielding = fit.residual - fit.model.residual(rigid)
    return tuple(curve.root @ yielding[at] for curve, at in fit.model.likelihood.slices())


def _bent(fit: Fit, changes: FloatArray) -> FloatArray:
    """(M, MODES k) changes of the residual where k of all curves (N, k) go by each mode over the input."""
    out, modes = np.zeros((fit.residual.size, MODES * changes.shape[1])), _modes()
    for group in fit.model.likelihood.groups:
        at = group.first.input / np.abs(group.first.input).max()
        along = np.array([np.interp(at, GRID, mode) for mode in modes]).T
        own = changes[group.place].reshape(len(group.curves), at.size, -1, 1) * along[:, None]
        out[group.place] = group.whitened(own.reshape(len(group.curves), at.size, -1))
    return np.where(fit.model.used[:, None], out, 0.0)


def _modes() -> FloatArray:
    """(MODES, 41) independent shapes of a smooth discrepancy without a mean, at GRID, each in its standard
    deviation."""
    squares, shapes = np.linalg.eigh(balanced_correlation(GRID))
    return np.asarray((np.sqrt(squares[-MODES:]) * shapes[:, -MODES:]).T)
