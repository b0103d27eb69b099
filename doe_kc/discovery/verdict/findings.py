"""From the last set of effects to findings: sizes with their uncertainty, probabilities, rivals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.special import logsumexp, ndtr

from doe_kc.discovery.fit import amplitude_estimates, member_detectability
from doe_kc.discovery.half_lines import half_line_limit, half_line_moments
from doe_kc.discovery.result import Finding, ParameterEstimate, Rival
from doe_kc.discovery.search.effect_search import EffectSearch
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    amounts,
    believable,
    more_than_none,
    more_than_trace,
)
from doe_kc.discovery.thresholds import (
    CONSTANT_TO,
    DECISIVE_EVIDENCE,
    NAME_LEVEL,
    NOISE_CHANCE,
    NOT_SHOWN,
    ONE_SIDED,
    OPTIMA_TO,
    RIVAL_LISTED,
    SIZE_SEEN,
    WRONG_NAME_CHANCE,
)
from doe_kc.discovery.verdict.alternatives import Alternatives
from doe_kc.discovery.verdict.exclusion import wrong_name_chance
from doe_kc.discovery.verdict.mixture import (
    spread_between_laws,
    spread_between_optima,
    spread_between_sets,
    spread_in_larger_sets,
)
from doe_kc.discovery.verdict.size_fit import SizeFit, size_fit
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects._friction import LIMIT
from doe_kc.effects.hypothesis import ABSENT, Hypothesis, Size
from doe_kc.ground.typing import FloatArray

NO_EFFECT = ""
"""In place of an effect's id: none at all."""


def findings(
    search: EffectSearch, compared: Sequence[Alternatives], workers: DiscoveryWorkers
) -> tuple[Finding, ...]:
    """Every member of the last set, each judged beside all the others. compared: in the set's order."""
    sized = size_fit(search, workers)
    return tuple(_finding(search, one, compared, sized) for one in compared)


def _stands_out(own: Alternatives) -> bool:
    """Whether the effect is more than noise, and than what the laws of the others could leave behind.

    Its loss is in errors that hold those laws' discrepancies. A weak effect is named where noise does not
    explain what remains without it.
    """
    strength = float(np.sqrt(2.0 * max(0.0, own.loss)))
    return strength >= NAME_LEVEL or own.removal_chance < NOISE_CHANCE


def _finding(
    search: EffectSearch, own: Alternatives, compared: Sequence[Alternatives], sized: SizeFit
) -> Finding:
    hypothesis = own.hypothesis
    logs = log_probabilities(own)
    against, odds = best_alternative(logs, hypothesis.effect)
    last, other = search.with_law_discrepancy, search.with_other_laws
    assumed, _ = amplitude_estimates(last, hypothesis)
    most_probable, sd = amplitude_estimates(sized.fit, hypothesis)
    sizes = [(s, float(a)) for s, a in zip(hypothesis.sizes, most_probable, strict=True)]
    sd = np.hypot(sd_of_one_number(hypothesis, most_probable, sd), sized.law_sd(hypothesis))
    between = np.hypot(
        spread_between_sets(hypothesis, assumed, compared),
        spread_between_laws(hypothesis, assumed, last, other),
    )
    alone, present, sd = sd, amounts_least(sizes, sd, between), np.hypot(sd, between)
    sd = np.hypot(sd, spread_between_optima(hypothesis, assumed, search.optima))
    sd = np.hypot(sd, spread_in_larger_sets(hypothesis, assumed, sd, search.larger))
    detectability = own.screened[0].detectability
    if sizes:
        detectability = member_detectability(search.with_effects, hypothesis)
    counted = amounts_of(sizes, sd)
    chances = _wrong_name_chances(own, detectability)
    for effect, chance in _confusion_chances(own).items():
        chances[effect] = max(chances.get(effect, 0.0), chance)
    rivals = tuple(
        Rival(effect, float(np.exp(log)))
        for effect, log in sorted(logs.items(), key=lambda item: -item[1])
        if effect not in (hypothesis.effect, NO_EFFECT) and np.exp(log) >= RIVAL_LISTED
    )
    return Finding(
        hypothesis=hypothesis,
        estimates=tuple(
            estimate(size, a, float(least), float(own_sd), float(whole))
            for (size, a), least, own_sd, whole in zip(
                sizes, np.maximum(np.abs(most_probable) - between, 0.0), alone, sd, strict=True
            )
        ),
        probability=float(np.exp(logs[hypothesis.effect])),
        log10_odds=odds,
        against=against,
        rivals=rivals,
        gain=own.loss,
        detectability=detectability,
        wrong_name=max(chances.values(), default=0.0),
        alike=_alike(own, chances),
        largest=max((a for _, a, _ in counted), default=1.0),
        believed=believable(counted),
        seen=more_than_none(present),
        relevant=more_than_trace(present) and not _trace_would_do(own) and _stands_out(own),
        small=not more_than_trace(present),
        elsewhere=_elsewhere(own),
    )


def amounts_of(amplitudes: Sequence[tuple[Size, float]], sd: FloatArray) -> list[tuple[Size, float, float]]:
    """Sizes that say how much, in typical ones, with their standard deviations (m,)."""
    return [(s, abs(a), float(e)) for (s, a), e in zip(amplitudes, sd, strict=True) if not s.shape]


def amounts_least(
    amplitudes: Sequence[tuple[Size, float]], sd: FloatArray, between: FloatArray
) -> list[tuple[Size, float, float]]:
    """Those where they are less by what other sets and laws make of them (m,), with their standard deviations
    in one set.

    In another set a size is another one and not none: a friction of 338 N on a mount of 4250 N/mm, certain
    and told as 447 +- 240 N, was neither an effect nor a trace.
    """
    told = zip(amounts_of(amplitudes, sd), amounts_of(amplitudes, between), strict=True)
    return [(size, max(0.0, amount - less), own) for (size, amount, own), (_, _, less) in told]


def sd_of_one_number(hypothesis: Hypothesis, most_probable: FloatArray, sd: FloatArray) -> FloatArray:
    """(m,) standard deviations; a friction's force is one number to `CONSTANT_TO` at best, a shape along
    which the cost has several optima to `OPTIMA_TO`."""
    amplitudes = zip(hypothesis.sizes, most_probable, strict=True)
    own = [_one_number_to(hypothesis, size, float(a)) for size, a in amplitudes]
    return np.asarray(np.hypot(sd, own))


def _one_number_to(hypothesis: Hypothesis, size: Size, amplitude: float) -> float:
    """Standard deviation of an amplitude, as far as one number stands for what it is at all travels, and as
    fits end at the optimum that is the car's."""
    if size.starts:
        return OPTIMA_TO / size.log_sd
    friction = EFFECTS[hypothesis.effect].frictional and size.key == LIMIT
    return CONSTANT_TO * amplitude if friction else 0.0


def log_probabilities(own: Alternatives) -> dict[str, float]:
    """Effect id -> ln of its probability in this place of the last set; NO_EFFECT: of none at all."""
    logs: dict[str, float] = {NO_EFFECT: 0.0}
    for t in own.trials:
        effect = t.hypothesis.effect
        log = t.gain / own.temper
        logs[effect] = float(np.logaddexp(logs.get(effect, -np.inf), log))
    total = float(logsumexp(list(logs.values())))
    return {effect: log - total for effect, log in logs.items()}


def best_alternative(logs: Mapping[str, float], effect: str) -> tuple[str, float]:
    """What is likeliest in an effect's stead, and log10 of the effect's odds against that."""
    others = {e: log for e, log in logs.items() if e != effect}
    best = max(others, key=lambda e: others[e])
    return best, float((logs[effect] - others[best]) / np.log(10.0))


def estimate(size: Size, amplitude: float, least: float, alone: float, sd: float) -> ParameterEstimate:
    """A size at its value, with the standard deviation of the value to first order.

    sd: of the amplitude; alone: in the last set at its optimum; least: what other sets and laws leave of the
    amplitude. By the last two the records tell it from none: elsewhere it is another one. A size that cannot
    be negative is taken at the mean of its half-line's Gaussian, so that one that the data do not see is not
    given as exactly nothing, with the standard deviation of that; below `SIZE_SEEN` with a limit. One that is
    as open as before the records is not shown by them.
    """
    shown = size.shape or alone < NOT_SHOWN
    limit = None
    if not size.any_sign and sd > 0.0:
        if shown and size.growth != "factor" and least < SIZE_SEEN * alone:
            limit = size.value(_limit_by_records(amplitude, min(sd, NOT_SHOWN)))
        amplitude, sd = half_line_moments(amplitude, sd)
    step = min(0.01, 0.1 * sd)
    floor = 0.0 if size.any_sign else step
    at = max(amplitude, floor)
    slope = (size.value(at + step) - size.value(at - step)) / (2.0 * step) if step > 0.0 else 0.0
    value, own = size.value(amplitude), abs(slope) * sd
    return ParameterEstimate(size.key, size.index, value, own, size.unit, limit, shown)


def _limit_by_records(amplitude: float, sd: float) -> float:
    """What an amplitude is below by the records alone, without its prior of standard deviation 1, which is
    a guess: a torsion of 12 440 Nm/deg was told as above 15 300 where no load case shows it."""
    information = sd**-2.0 - 1.0
    alone = amplitude * sd**-2.0 / information
    return half_line_limit(alone, float(information**-0.5), ONE_SIDED)


def _wrong_name_chances(own: Alternatives, detectability: float) -> dict[str, float]:
    """Effect id -> chance that noise names it instead, from the remaining changes without the effect."""
    out: dict[str, float] = {}
    for effect, correlation in own.change.correlations:
        if effect != own.hypothesis.effect:
            chance = wrong_name_chance(detectability, correlation)
            out[effect] = max(out.get(effect, 0.0), chance)
    return out


def _confusion_chances(own: Alternatives) -> dict[str, float]:
    """Effect id -> chance that noise alone puts its refit before the effect's own, in truth the right one.

    Phi(-d / 2), d the distance of what both predict in standard deviations of the records.
    """
    first, *rest = own.trials
    out: dict[str, float] = {}
    for t in rest:
        effect = t.hypothesis.effect
        if effect != first.hypothesis.effect and _has_needed_sizes(t):
            apart = float(np.linalg.norm(t.fit.residual - first.fit.residual))
            out[effect] = max(out.get(effect, 0.0), float(ndtr(-apart / 2.0)))
    return out


def _has_needed_sizes(trial: HypothesisFit) -> bool:
    """Whether the sizes are there that make it: a free play without a gap is a compliance by another name."""
    return all(abs(a) > max(ABSENT, sd) for s, a, sd in amounts(trial) if s.needed)


def _alike(own: Alternatives, chances: Mapping[str, float]) -> tuple[str, ...]:
    """Effects that the records hardly tell from this one and whose evidence is not decisively less.

    By the records alone: what is rarer before them is not told apart by that. A wrong steering input of the
    rig was named as a wrong steering ratio, 160 to 1 before the records and 1 to 1.2 by them.
    """
    best = max(t.gain - t.prior for t in own.trials if t.hypothesis.effect == own.hypothesis.effect)
    rivals = (t for t in own.trials if t.hypothesis.effect != own.hypothesis.effect and _has_needed_sizes(t))
    close = dict.fromkeys(
        t.hypothesis.effect for t in rivals if (best - (t.gain - t.prior)) / own.temper < DECISIVE_EVIDENCE
    )
    return tuple(e for e in close if chances.get(e, 0.0) > WRONG_NAME_CHANCE)


def _trace_would_do(own: Alternatives) -> bool:
    """Whether a trace of another effect explains the records about as well: every car has those."""
    first, *rest = own.trials
    return any(
        t.hypothesis.effect != own.hypothesis.effect
        and t.gain > 0.0
        and (first.gain - t.gain) / own.temper < DECISIVE_EVIDENCE
        and not more_than_trace(amounts(t))
        for t in rest
    )


def _elsewhere(own: Alternatives) -> tuple[str, ...]:
    """Other places of the same effect whose evidence is not decisively less."""
    first, *rest = own.trials
    others = (t for t in rest if t.hypothesis.effect == own.hypothesis.effect)
    close = (t for t in others if (first.gain - t.gain) / own.temper < DECISIVE_EVIDENCE)
    return tuple(t.hypothesis.location for t in close if t.hypothesis.location)
