"""From the search's steps to findings: sizes with their uncertainty, probabilities, rivals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import log_ndtr, logsumexp, ndtr

from doe_kc.discovery.belief import believed, matters
from doe_kc.discovery.disagreement import NOISE
from doe_kc.discovery.fit import Fit
from doe_kc.discovery.projection import projection
from doe_kc.discovery.result import Estimate, Finding, Rival
from doe_kc.discovery.screen import Screened
from doe_kc.discovery.search import Search, Step, accepted_steps
from doe_kc.discovery.standing import wrong_name_chance
from doe_kc.discovery.trials import Trial, amounts
from doe_kc.discovery.unseen import unseen
from doe_kc.effects.hypothesis import ABSENT, Hypothesis, Size
from doe_kc.typing import FloatArray

WEAK, STRONG = 6.0, 10.0
"""Standard deviations below which an effect is not named by them alone, and from which it is named beside any
other."""
BESIDE = 0.01
"""Share of the largest gain from which an effect between the two is named where laws had to be opened."""
UNLISTED = 0.02
"""Prior odds that an effect outside the library, which looks like the one named, is at work instead."""
ALIKE = 0.05
"""Chance of a wrong name from which two effects are alike to the records."""
DECISIVE = 4.6
"""ln evidence, a hundred to one, that settles even between effects that are alike."""
MENTIONED = 0.01
"""Probability from which a rival is listed."""


def findings(found: Search, unexplained: float) -> tuple[Finding, ...]:
    """Every member of the final model. unexplained: chance that noise alone leaves what remains."""
    hidden = unseen(found)
    every = [
        _finding(found, h, place, hidden[place.start - found.final.model.dimension :], unexplained)
        for h, place in found.final.model.places()
    ]
    most = max((f.gain for f in every), default=0.0)
    least = BESIDE * most if any(found.shares.values()) else 0.0
    return tuple(replace(f, relevant=f.relevant and _stands_out(found, f, least)) for f in every)


def _stands_out(found: Search, finding: Finding, least: float) -> bool:
    """Whether the effect is more than what the law of a much larger one could leave behind.

    A weak one is named where noise did not explain what remained without it.
    """
    strength = float(np.sqrt(2.0 * max(0.0, found.losses[finding.hypothesis.name])))
    asked = accepted_at(found, finding.hypothesis).map.chance < NOISE
    return strength >= STRONG or ((strength >= WEAK or asked) and finding.gain >= least)


def _finding(
    found: Search, hypothesis: Hypothesis, place: slice, hidden: FloatArray, unexplained: float
) -> Finding:
    """hidden: standard deviations by effects that are not seen, of its sizes and those behind them."""
    final = found.final
    step = accepted_at(found, hypothesis)
    shares = probabilities(step.trials, step.temper, unexplained)
    amplitudes = found.plain.z[place]
    sizes = [(s, float(a)) for s, a in zip(hypothesis.sizes, amplitudes, strict=True)]
    sd = _with_law(hypothesis, amplitudes, np.sqrt(np.diag(final.covariance))[place], found.shares)
    own = next(s for s in step.screened if s.hypothesis == hypothesis)
    detectability = _detectability(found.plain, place) if sizes else own.detectability
    counted = [(s, abs(a), float(e)) for (s, a), e in zip(sizes, sd, strict=True) if not s.shape]
    chances = _wrong_names(step, own, detectability)
    for effect, chance in _mistaken(step).items():
        chances[effect] = max(chances.get(effect, 0.0), chance)
    rivals = tuple(
        Rival(effect, p)
        for effect, p in sorted(shares.items(), key=lambda item: -item[1])
        if effect != hypothesis.effect and p >= MENTIONED
    )
    return Finding(
        hypothesis=hypothesis,
        estimates=tuple(
            estimate(s, a, float(np.hypot(e, more)))
            for (s, a), e, more in zip(sizes, sd, hidden[: len(sizes)], strict=True)
        ),
        probability=shares.get(hypothesis.effect, 0.0),
        rivals=rivals,
        gain=next(t.gain for t in step.trials if t.hypothesis == hypothesis),
        detectability=detectability,
        wrong_name=max(chances.values(), default=0.0),
        alike=_alike(step, own, chances),
        largest=max((a for _, a, _ in counted), default=1.0),
        believed=believed(counted),
        relevant=matters(counted) and not _trace_would_do(step, hypothesis),
        elsewhere=_elsewhere(step, hypothesis),
    )


def _with_law(
    hypothesis: Hypothesis, amplitudes: FloatArray, sd: FloatArray, shares: Mapping[str, float]
) -> FloatArray:
    """(m,) standard deviations; a stiffness whose law is another is not one number but a range."""
    share = shares.get(hypothesis.name, 0.0)
    own = [
        share * a if s.growth == "compliance" else 0.0
        for s, a in zip(hypothesis.sizes, amplitudes, strict=True)
    ]
    return np.asarray(np.hypot(sd, own))


def accepted_at(found: Search, hypothesis: Hypothesis) -> Step:
    """The step that brought a member in."""
    return next(s for s in accepted_steps(found) if s.trials[0].hypothesis == hypothesis)


def probabilities(trials: Sequence[Trial], temper: float, unexplained: float) -> dict[str, float]:
    """Effect id -> probability among the refitted ones, none at all, and one outside the library.

    Prior odds are equal for all effects, shared between the places of each. What remains unexplained counts
    against all: a Bayes factor of at most -e p ln p for the model (T. Sellke, M. J. Bayarri, J. O. Berger,
    The American Statistician 55, 2001).
    """
    logs = {t.hypothesis.name: t.gain / temper for t in trials}
    top = max(logs.values())
    p = min(max(unexplained, 1e-4), 1.0)
    support = -np.e * p * np.log(p) if p < np.exp(-1.0) else 1.0
    unlisted = top + float(np.log(UNLISTED / support))
    total = float(logsumexp([*logs.values(), 0.0, unlisted]))
    out: dict[str, float] = {}
    for t in trials:
        share = float(np.exp(logs[t.hypothesis.name] - total))
        out[t.hypothesis.effect] = out.get(t.hypothesis.effect, 0.0) + share
    return out


def estimate(size: Size, amplitude: float, sd: float) -> Estimate:
    """A size at its value, with the standard deviation of the value to first order.

    A size that cannot be negative is taken at the mean of its half-line's Gaussian, so that one that the
    data do not see is not given as exactly nothing.
    """
    if not (size.signed or size.shape) and sd > 0.0:
        inverse_mills = float(np.exp(-0.5 * (amplitude / sd) ** 2 - log_ndtr(amplitude / sd)))
        amplitude += sd * inverse_mills / float(np.sqrt(2.0 * np.pi))
    step = min(0.01, 0.1 * sd)
    floor = 0.0 if size.signed or size.shape else step
    at = max(amplitude, floor)
    slope = (size.value(at + step) - size.value(at - step)) / (2.0 * step) if step > 0.0 else 0.0
    return Estimate(size.key, size.index, size.value(amplitude), abs(slope) * sd, size.unit)


def _detectability(final: Fit, place: slice) -> float:
    """Standard deviations that the effect makes at its size, all else re-tuned."""
    covariance = final.covariance[place, place]
    information = np.linalg.inv(covariance) - np.eye(covariance.shape[0])
    amplitudes = final.z[place]
    return float(np.sqrt(max(0.0, float(amplitudes @ information @ amplitudes))))


def _wrong_names(step: Step, own: Screened, detectability: float) -> dict[str, float]:
    """Effect id -> chance that noise names it instead, from the remaining changes where the search stood."""
    project = projection(step.before)
    direction = _unit(project(own.change))
    out: dict[str, float] = {}
    for s in step.screened:
        effect = s.hypothesis.effect
        if effect != own.hypothesis.effect and not s.failed:
            chance = wrong_name_chance(detectability, float(direction @ _unit(project(s.change))))
            out[effect] = max(out.get(effect, 0.0), chance)
    return out


def _mistaken(step: Step) -> dict[str, float]:
    """Effect id -> chance that noise alone puts its refit before the best one's, in truth the right one.

    Phi(-d / 2), d the distance of what both predict in standard deviations of the records.
    """
    best, *rest = step.trials
    out: dict[str, float] = {}
    for t in rest:
        effect = t.hypothesis.effect
        if effect != best.hypothesis.effect and _whole(t):
            apart = float(np.linalg.norm(t.fit.residual - best.fit.residual))
            out[effect] = max(out.get(effect, 0.0), float(ndtr(-apart / 2.0)))
    return out


def _whole(trial: Trial) -> bool:
    """Whether the sizes are there that make it: a free play without a gap is a compliance by another name."""
    return all(abs(a) > max(ABSENT, sd) for s, a, sd in amounts(trial) if s.needed)


def _alike(step: Step, own: Screened, chances: Mapping[str, float]) -> tuple[str, ...]:
    """Effects that the records hardly tell from this one and whose evidence is not decisively less."""
    best = max(t.gain for t in step.trials if t.hypothesis.effect == own.hypothesis.effect)
    rivals = (t for t in step.trials if t.hypothesis.effect != own.hypothesis.effect and _whole(t))
    close = dict.fromkeys(t.hypothesis.effect for t in rivals if (best - t.gain) / step.temper < DECISIVE)
    return tuple(e for e in close if chances.get(e, 0.0) > ALIKE)


def _trace_would_do(step: Step, own: Hypothesis) -> bool:
    """Whether a trace of another effect explains the records about as well: every car has those."""
    best = next(t.gain for t in step.trials if t.hypothesis == own)
    return any(
        t.hypothesis.effect != own.effect
        and t.gain > 0.0
        and (best - t.gain) / step.temper < DECISIVE
        and not matters(amounts(t))
        for t in step.trials
    )


def _elsewhere(step: Step, own: Hypothesis) -> tuple[str, ...]:
    """Other places of the same effect whose evidence is not decisively less."""
    best = next(t.gain for t in step.trials if t.hypothesis == own)
    others = (t for t in step.trials if t.hypothesis.effect == own.effect and t.hypothesis != own)
    close = (t for t in others if (best - t.gain) / step.temper < DECISIVE)
    return tuple(t.hypothesis.location for t in close if t.hypothesis.location)


def _unit(seen: FloatArray) -> FloatArray:
    length = float(np.linalg.norm(seen))
    return np.asarray(seen / length if length > 1e-9 else 0.0 * seen)
