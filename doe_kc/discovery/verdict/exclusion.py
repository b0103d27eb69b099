"""The status of every hypothesis of the library: found, excluded above a size, not testable or unresolved."""

from __future__ import annotations

import math
from collections.abc import Sequence, Set
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.special import ndtr

from doe_kc.discovery.fit import Fit, amplitude_estimates
from doe_kc.discovery.linear_nuisances import trace_mean
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.thresholds import (
    ALIKE_CORRELATION,
    HIDING_LISTED,
    ONE_SIDED,
    POWER,
    TRACE_SD,
    UNSURE_SHARE,
)
from doe_kc.discovery.verdict.component_test import ComponentTest, component_tests
from doe_kc.effects.hypothesis import Hypothesis, Size
from doe_kc.ground.typing import FloatArray

Status = Literal["found", "trace", "excluded", "unresolved", "not testable", "no solution"]


@dataclass(frozen=True)
class HypothesisStatus:
    """What the records say of one hypothesis."""

    hypothesis: Hypothesis
    """The effect in its place."""
    status: Status
    """excluded from its limits on where the model holds; unresolved where it does not."""
    detectable: float
    """The smallest of the limits."""
    absorbed: float
    """Share of the effect's change, squared, that re-tuning hides, 0 to 1."""
    hidden_by: tuple[tuple[str, float], ...]
    """Tunable parameters that do so, with their move in standard deviations of the prior."""
    alike: tuple[tuple[str, float], ...]
    """Names of hypotheses whose remaining change is the same, with the correlation, -1 to 1."""
    limits: tuple[float, ...] = ()
    """(m,) of each of its sizes the smallest amplitude, as a multiple of the typical one, that would be found
    in 80 % of cars whatever the others are and that is above the 95 % limit of what the records say of it, if
    the model is right but for this size; inf when re-tuning absorbs nearly all, or a member may stand in its
    place, nan for a shape."""
    component_test: ComponentTest | None = None
    """Parts to measure that would show it, where it hardly shows; None otherwise."""


def hypothesis_statuses(
    fit: Fit,
    screened: Sequence[Screened],
    members: Sequence[tuple[Screened, Status]],
    critical: float,
    *,
    resolved: bool,
    masked: Set[str] = frozenset(),
) -> tuple[HypothesisStatus, ...]:
    """The status of members and of all others, screened at the end.

    critical: |z| that a hypothesis must reach among so many. resolved: whether the model holds, so that what
    it does not see can be excluded. masked: names of those in whose place a member may stand, see
    `EffectSearch.larger`: whatever their size, the records do not show it. A mount of the rack of 7260 N/mm
    was excluded below 25 600 beside a friction that was told as wide as a set with it.
    """
    everything = [s for s, _ in members] + list(screened)
    known = dict(enumerate(status for _, status in members))
    changes = fit.changes(np.array([s.change for s in everything]).T)
    length = np.sqrt(fit.tuning_projection.squares(changes))
    safe = np.where(length > 0, length, 1.0)
    correlation = fit.tuning_projection.gram_of(changes) / np.outer(safe, safe)
    moves = fit.tuning_projection.moves(changes)
    out = []
    for i, s in enumerate(everything):
        by_bounds = float(np.linalg.norm(moves[:, i]))
        limits = _limits(s, by_bounds, critical)
        if i in known:
            limits = np.fmin(limits, _member_limits(fit, s.hypothesis, critical))
        else:
            limits = np.maximum(limits, np.inf if s.hypothesis.name in masked else _upper(s))
        amounts = limits[~np.isnan(limits)]
        seen = trusted_detectability(s.detectability, float(np.linalg.norm(s.change)), by_bounds)
        detectable = float(amounts.min()) if amounts.size else _limit(seen, critical)
        status: Status = known.get(i) or _status(s, detectable, resolved=resolved)
        alike = tuple(
            (everything[j].hypothesis.name, float(correlation[i, j]))
            for j in np.argsort(-np.abs(correlation[i]))
            if j != i and abs(correlation[i, j]) >= ALIKE_CORRELATION and length[i] > 1.0 and length[j] > 1.0
        )
        hidden_by = _hiding(fit, moves[:, i], s)
        out.append(
            HypothesisStatus(s.hypothesis, status, detectable, s.absorbed, hidden_by, alike, tuple(limits))
        )
    untested = [i for i, s in enumerate(out) if s.status in ("not testable", "trace")]
    tests = component_tests(fit, [everything[i] for i in untested], critical + POWER)
    for i, test in zip(untested, tests, strict=True):
        out[i] = replace(out[i], component_test=test)
    return tuple(out)


def exclusion_limit(size: Size, amplitude: float) -> float | None:
    """The option's number at an amplitude from which it is excluded; None beyond any believed size."""
    return size.value(amplitude) if amplitude <= size.most else None


def _limits(screened: Screened, by_bounds: float, critical: float) -> FloatArray:
    """(m,) see `HypothesisStatus`. by_bounds: see `trusted_detectability`."""
    sizes = screened.hypothesis.sizes
    if sum(not s.shape for s in sizes) == 1:
        seen = trusted_detectability(
            screened.detectability, float(np.linalg.norm(screened.change)), by_bounds
        )
        return np.array([np.nan if s.shape else trace_mean(s) + _limit(seen, critical) for s in sizes])
    lengths = np.linalg.norm(screened.columns, axis=0)
    return np.array(
        [
            trace_mean(s) + _limit(trusted_detectability(v, w, 0.0), critical)
            for s, v, w in zip(sizes, screened.size_detectability, lengths, strict=True)
        ]
    )


def _member_limits(fit: Fit, hypothesis: Hypothesis, critical: float) -> FloatArray:
    """(m,) see `HypothesisStatus`, of a member of the set, by what the records tell of its sizes beside all
    others; nan for a shape.

    How it was screened, before the others, may say less: a clamp told to 3.5 % was undetectable beside strut
    friction that was not yet in the model. Nor does this say more of every effect: rubber is there for sure
    where only its mean over unlike bushings is open.
    """
    member = fit.model.member(hypothesis.name)
    _, posterior = amplitude_estimates(fit, member)
    seen = {
        size.name: math.sqrt(max(0.0, sd**-2.0 - 1.0))
        for size, sd in zip(member.sizes, posterior.tolist(), strict=True)
        if not size.shape
    }
    return np.array(
        [
            trace_mean(s) + _limit(seen[s.name], critical) if s.name in seen else np.nan
            for s in hypothesis.sizes
        ]
    )


def trusted_detectability(visible: float, before: float, by_bounds: float) -> float:
    """Standard deviations that are believed of those that re-tuning leaves of an effect.

    before: before re-tuning. by_bounds: the part that is left because parameters would have to move too far,
    which no bend of theirs undoes; the rest are deviations of the records.
    """
    left = visible**2 - by_bounds**2
    return by_bounds if left <= UNSURE_SHARE * before**2 else visible


def _limit(visible: float, critical: float) -> float:
    """Amplitude, over the mean of its trace, from which a size that makes `visible` standard deviations when
    typical would be found. Beside a trace of the same effect, which every car has."""
    return float("inf") if visible <= 0.0 else (critical + POWER) * float(np.hypot(1.0 / visible, TRACE_SD))


def _upper(screened: Screened) -> FloatArray:
    """(m,) amplitudes that the sizes pass with a chance of 5 %, to first order. What was screened comes on
    top of a trace."""
    means = np.array([trace_mean(s) for s in screened.hypothesis.sizes])
    return np.asarray(means + np.abs(screened.amplitudes) + ONE_SIDED * screened.sd)


def _status(screened: Screened, detectable: float, *, resolved: bool) -> Status:
    if screened.failed:
        return "no solution"
    if detectable > 1.0:
        return "not testable"
    return "excluded" if resolved else "unresolved"


def _hiding(fit: Fit, move: FloatArray, screened: Screened) -> tuple[tuple[str, float], ...]:
    """move: (d,) by which what can be tuned follows the effect, in standard deviations of its prior."""
    if screened.absorbed < 0.5:
        return ()
    paths = fit.model.space.paths
    relative = move[: len(paths)]
    order = np.argsort(-np.abs(relative))[:HIDING_LISTED]
    return tuple((paths[i], float(relative[i])) for i in order)


def wrong_name_chance(detectability: float, correlation: float) -> float:
    """Chance that noise names a rival of one parameter instead of the true effect of one parameter.

    detectability: standard deviations of the effect after re-tuning. correlation: of both remaining
    changes. P = Phi(-a) Phi(b) + Phi(a) Phi(-b), a, b = detectability sqrt((1 -+ |correlation|) / 2).
    """
    a = detectability * np.sqrt((1.0 - abs(correlation)) / 2.0)
    b = detectability * np.sqrt((1.0 + abs(correlation)) / 2.0)
    return float(ndtr(-a) * ndtr(b) + ndtr(a) * ndtr(-b))
