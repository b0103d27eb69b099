"""Proposals: the sets of effects that are probable to first order, by adding, removing and exchanging.

All columns are projected once; then the evidence of a set follows from a few rows of one Gram matrix, in some
microseconds. Effects are linear about their own screened sizes, members about the fit. That is a proposal
only: what a set is worth, its joint refit says (D. Madigan, A. E. Raftery, Journal of the American
Statistical Association 89, 1994).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.search.compatibility import compatible_set
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import AMPLITUDE_LIMIT, PROPOSAL_MOVES, PROPOSAL_PAIRS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray

Members = frozenset[int]
"""Places of hypotheses in `LinearSets.hypotheses`."""


@dataclass(frozen=True)
class SetProposal:
    """A set of effects, its evidence to first order."""

    members: tuple[Hypothesis, ...]
    """Its effects, those of the fit first, in their order."""
    amplitudes: FloatArray
    """(m,) of all members in this order."""
    gain: float
    """ln of the posterior odds against the set of the fit."""


@dataclass(frozen=True)
class LinearSets:
    """Everything that the evidence of sets takes, to first order about a fit."""

    hypotheses: tuple[Hypothesis, ...]
    """(h,) members of the fit, then those screened."""
    places: tuple[slice, ...]
    """(h,) of each one's sizes among the k columns."""
    gram: FloatArray
    """(k + h + 1, k + h + 1) inner products of columns, of what effects do beyond them, and of the residual
    without any."""
    low: FloatArray
    """(k,) lower bounds of the amplitudes."""
    high: FloatArray
    """(k,) upper bounds."""
    prior: SetPrior
    """Of sets."""
    count: int
    """Members of the fit."""

    @staticmethod
    def of(current: Fit, screened: Sequence[Screened], prior: SetPrior) -> LinearSets:
        """About a fit; screened: with their changes in its errors."""
        model = current.model
        others = [s for s in screened if not s.failed]
        hypotheses = (*model.members, *(s.hypothesis for s in others))
        ends = np.cumsum([0, *(len(h.sizes) for h in hypotheses)])
        own, none = current.jacobian.own[:, model.calibrations.stop :], np.zeros(current.residual.size)
        columns = np.hstack([own, *(s.columns for s in others)])
        bends = np.array([none for _ in model.members] + [_beyond(s) for s in others]).reshape(-1, none.size)
        gram = _gram(current, np.hstack([columns, bends.T]), own @ current.amplitudes)
        sizes = [s for h in hypotheses for s in h.sizes]
        return LinearSets(
            hypotheses,
            tuple(slice(a, b) for a, b in pairwise(ends)),
            gram,
            np.array([-AMPLITUDE_LIMIT * s.most if s.any_sign else 0.0 for s in sizes]),
            np.array([AMPLITUDE_LIMIT * s.most for s in sizes]),
            prior,
            len(model.members),
        )

    def evidence(self, members: Members) -> tuple[float, FloatArray]:
        """ln posterior of a set, relative to a constant of all, and (m,) its amplitudes in order."""
        return self.evidences([members])[members]

    def evidences(self, sets: Collection[Members]) -> dict[Members, tuple[float, FloatArray]]:
        """What `evidence` says of each set; those of as many effects and sizes are solved together."""
        alike: dict[tuple[int, int], list[Members]] = {}
        for members in sets:
            count = sum(stop - start for start, stop in (self._ends[i] for i in members))
            alike.setdefault((len(members), count), []).append(members)
        known = {members: one for same in alike.values() for members, one in self._together(same)}
        return {members: known[members] for members in sets}

    def _together(self, sets: Sequence[Members]) -> Iterator[tuple[Members, tuple[float, FloatArray]]]:
        """Of sets of as many effects and sizes."""
        orders = [sorted(members) for members in sets]
        columns = np.array([[c for i in order for c in range(*self._ends[i])] for order in orders], dtype=int)
        last, first = self.gram.shape[0] - 1, self.low.size
        there = np.array([[*(first + i for i in order), last] for order in orders])
        constant = self.gram[there[:, :, None], there[:, None]].sum(axis=(1, 2))
        slope = self.gram[columns[:, :, None], there[:, None]].sum(axis=2)
        hessian = self.gram[columns[:, :, None], columns[:, None]] + np.eye(columns.shape[1])
        amplitudes = _within(hessian, slope, self.low[columns], self.high[columns])
        bent = (hessian @ amplitudes[..., None])[..., 0]
        cost = constant + np.sum((2.0 * slope + bent) * amplitudes, axis=1)
        occam = 0.5 * np.linalg.slogdet(hessian)[1]
        for members, order, gain, own in zip(sets, orders, -0.5 * cost - occam, amplitudes, strict=True):
            yield members, (float(gain) + self.prior.log([self.hypotheses[i] for i in order]), own)

    @cached_property
    def _ends(self) -> list[tuple[int, int]]:
        """(h,) first column of each hypothesis, and that behind its last."""
        return [(place.start, place.stop) for place in self.places]

    def proposals(self) -> list[SetProposal]:
        """Sets visited on the way to the most probable one, the most probable first."""
        current = frozenset(range(self.count))
        values = {current: self.evidence(current)}
        best = current
        for _ in range(PROPOSAL_MOVES):
            values |= self.evidences([m for m in dict.fromkeys(self._moves(best)) if m not in values])
            pairs = self._pairs(best, {m: v[0] for m, v in values.items()})
            values |= self.evidences([m for m in dict.fromkeys(pairs) if m not in values])
            following = max(values, key=lambda m: values[m][0])
            if following == best:
                break
            best = following
        base = values[current][0]
        order = sorted((m for m in values if m != current), key=lambda m: -values[m][0])
        return [self._proposal(m, values[m][1], values[m][0] - base) for m in order]

    def loss(self, proposal: SetProposal, member: Hypothesis) -> float:
        """ln posterior odds that a proposed set loses without one of its effects."""
        there = frozenset(self.hypotheses.index(h) for h in proposal.members)
        return self.evidence(there)[0] - self.evidence(there - {self.hypotheses.index(member)})[0]

    def _proposal(self, members: Members, amplitudes: FloatArray, gain: float) -> SetProposal:
        return SetProposal(tuple(self.hypotheses[i] for i in sorted(members)), amplitudes, gain)

    def _moves(self, members: Members) -> Iterator[Members]:
        """One effect more, one less, or one for another."""
        outside = [i for i in range(len(self.hypotheses)) if i not in members]
        fewer = [members - {i} for i in members if self._linear(i)]
        yield from fewer
        for base in (members, *fewer):
            for i in outside:
                if self._compatible(base | {i}):
                    yield base | {i}

    def _pairs(self, members: Members, values: dict[Members, float]) -> Iterator[Members]:
        """Two effects more, or two for one, of those that do best alone."""
        for base in (members, *(members - {i} for i in members if self._linear(i))):
            single = [m - base for m in values if base < m and len(m) == len(base) + 1]
            single.sort(key=lambda one: -values[base | one])
            for one, other in combinations(single[:PROPOSAL_PAIRS], 2):
                if self._compatible(base | one | other):
                    yield base | one | other

    def _linear(self, i: int) -> bool:
        """Whether it can be taken out to first order: a member without sizes has no columns."""
        return i >= self.count or bool(self.hypotheses[i].sizes)

    def _compatible(self, members: Members) -> bool:
        return compatible_set([self.hypotheses[i] for i in members])


def _gram(current: Fit, rows: FloatArray, effects: FloatArray) -> FloatArray:
    """(k + 1, k + 1) inner products of changes (M, k) and of the residual without that of effects (M,)."""
    seen, changes = current.sizes_held, current.changes(np.hstack([rows, effects[:, None]]))
    out = seen.gram_of(changes)
    own = out[:, -1].copy()
    along = seen.inner(changes, current.remainder)[:, 0]
    out[:, -1] = out[-1] = along - own
    out[-1, -1] = float(seen.squares(current.remainder)[0]) - 2.0 * along[-1] + own[-1]
    return out


def _beyond(screened: Screened) -> FloatArray:
    """(M,) what the effect does that its columns do not say; all of it for one without sizes."""
    return screened.bend if screened.amplitudes.size else screened.change


def _within(hessian: FloatArray, slope: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """(s, m) minimizers of s quadratics (s, m, m) with slopes (s, m), each amplitude that passes a bound held
    there."""
    amplitudes = np.asarray(-np.linalg.solve(hessian, slope[..., None])[..., 0], dtype=np.float64)
    for i in np.flatnonzero(((amplitudes < low) | (amplitudes > high)).any(axis=1)):
        amplitudes[i] = _held_within(hessian[i], slope[i], low[i], high[i], amplitudes[i])
    return amplitudes


def _held_within(
    hessian: FloatArray, slope: FloatArray, low: FloatArray, high: FloatArray, amplitudes: FloatArray
) -> FloatArray:
    """(m,) minimizer of one of them. amplitudes: (m,) that without bounds."""
    outside = (amplitudes < low) | (amplitudes > high)
    held = np.where(outside, np.clip(amplitudes, low, high), amplitudes)
    free = ~outside
    for _ in range(slope.size):
        if not free.any():
            break
        pull = hessian[np.ix_(free, ~free)] @ held[~free]
        held[free] = -np.linalg.solve(hessian[np.ix_(free, free)], slope[free] + pull)
        outside = free & ((held < low) | (held > high))
        if not outside.any():
            break
        held[outside] = np.clip(held[outside], low[outside], high[outside])
        free &= ~outside
    return held
