"""Refits that begin at the nominal axle: where bounds hold many parameters, or a fault of the rig leads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.screening.screen import Screened
from doe_kc.discovery.screening.within_bounds import (
    BoundedGain,
    gains_within_bounds,
    many_held,
    nominal_fit,
)
from doe_kc.discovery.search.compatibility import compatible_set
from doe_kc.discovery.search.refits import (
    HypothesisFit,
    hypothesis_fit,
    plausible,
    set_fit,
    useful_cost,
)
from doe_kc.discovery.search.rig_faults import leading_rig_fault
from doe_kc.discovery.search.set_prior import SetPrior
from doe_kc.discovery.thresholds import (
    ACCEPTED_ODDS,
    NOISE_CHANCE,
    NOMINAL_REFITS,
)
from doe_kc.discovery.workers import DiscoveryWorkers
from doe_kc.effects import EFFECTS
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray
from doe_kc.solver.result import NotConverged


def refits_from_nominal(
    current: Fit,
    screened: Sequence[Screened],
    first_screened: Sequence[Screened],
    trials: Sequence[HypothesisFit],
    prior: SetPrior,
    workers: DiscoveryWorkers,
) -> list[HypothesisFit]:
    """Refits that begin at the nominal axle, where noise does not explain what remains and bounds hold many
    parameters back: of the effects that promise most there, then of the best of all with each of the others
    that gain, as one set. Where a fault of the rig leads, of what led before any effect.

    From an axle that is bent a refit may not find back, and beside one of two large effects the other does
    not show; a fault of the rig may be all that it sees of an effect of the car. first_screened: as they were
    screened before any effect. trials: other refits of the same step, which count among all.
    """
    bent, first = many_held(current), leading_at_first(first_screened, current.model)
    if current.residual_map.chance >= NOISE_CHANCE or not (bent or (first and leading_rig_fault(trials))):
        return []
    try:
        nominal = nominal_fit(current)
    except NotConverged:
        return []
    leading = leading_from_nominal(gains_within_bounds(nominal, screened)) if bent else []
    known = {one.screened.hypothesis.effect for one in leading}
    alone = [(one.screened.hypothesis, one.amplitudes) for one in leading]
    alone += [(s.hypothesis, s.amplitudes) for s in first if s.hypothesis.effect not in known]
    starts = [
        _from_nominal(nominal, [h], [amplitudes], useful_cost(current, h, ACCEPTED_ODDS, prior))
        for h, amplitudes in alone
    ]
    fits = workers.fits(starts, "refitting from the nominal axle")
    own = [hypothesis_fit(refit, current, prior) for refit in fits if refit is not None]
    return own + (_pair_refits(current, nominal, [*trials, *own], prior, workers) if bent else [])


def refit_anew(current: Fit, workers: DiscoveryWorkers) -> Fit | None:
    """The same set, fitted from the nominal axle with its effects as they are; None where that brings
    nothing, or noise explains what remains.

    A free play makes the cost rough: beside a friction its fit ended at four times the cost of another one.
    """
    if current.residual_map.chance >= NOISE_CHANCE:
        return None
    try:
        nominal = nominal_fit(current)
    except NotConverged:
        return None
    start = FitStart(current.model, nominal.z, nominal, current.cost)
    (refit,) = workers.fits([start], "refitting from the nominal axle")
    if refit is None or refit.evidence - current.evidence <= ACCEPTED_ODDS:
        return None
    return refit


def leading_from_nominal(gains: Sequence[BoundedGain]) -> list[BoundedGain]:
    """Of the effects that gain the first ones between the bounds, and the first ones by their screening: a
    ride height far from its place is hardly linear, and leads by one of them at most."""
    best: dict[str, BoundedGain] = {}
    for one in gains:
        if one.gain > ACCEPTED_ODDS:
            best.setdefault(one.screened.hypothesis.effect, one)
    by_screening = sorted(best.values(), key=lambda one: -one.screened.gain)
    first = {id(one) for one in by_screening[:NOMINAL_REFITS]}
    return [one for i, one in enumerate(best.values()) if i < NOMINAL_REFITS or id(one) in first]


def leading_at_first(first_screened: Sequence[Screened], model: EffectModel) -> list[Screened]:
    """Of the effects that the model lacks and can take, the first ones by their screening before any effect:
    beside a friction that bends the axle, a ride height 7 mm off promised -3 of ln evidence, and 36 000
    before."""
    best: dict[str, Screened] = {}
    has = {h.effect for h in model.members}
    for s in sorted(first_screened, key=lambda s: -s.gain):
        if s.gain > ACCEPTED_ODDS and s.hypothesis.effect not in has:
            best.setdefault(s.hypothesis.effect, s)
    return list(best.values())[:NOMINAL_REFITS]


def _pair_refits(
    current: Fit,
    nominal: Fit,
    trials: Sequence[HypothesisFit],
    prior: SetPrior,
    workers: DiscoveryWorkers,
) -> list[HypothesisFit]:
    """The refits of the best trial's effect with each other one that gains, each against the set of
    `current`; where that is a fault of the rig, of the best effect of the car too."""
    before = current.model.members
    best: dict[str, HypothesisFit] = {}
    for trial in sorted(trials, key=lambda t: -t.gain):
        alone = trial.fit.model.members == (*before, trial.hypothesis)
        if alone and trial.gain > ACCEPTED_ODDS and plausible(trial):
            best.setdefault(trial.hypothesis.effect, trial)
    if not best:
        return []
    pairs = [
        (one, other)
        for one, other in leading_pairs(list(best.values())[: 1 + NOMINAL_REFITS])
        if compatible_set([*before, one.hypothesis, other.hypothesis])
    ]
    single, *_ = best.values()
    starts = [
        _from_nominal(
            nominal,
            [t.hypothesis for t in pair],
            [own_amplitudes(t) for t in pair],
            useful_cost(single.fit, pair[-1].hypothesis, 0.0, prior),
        )
        for pair in pairs
    ]
    fits = workers.fits(starts, "refitting pairs")
    return [set_fit(refit, current, prior) for refit in fits if refit is not None]


def leading_pairs(trials: Sequence[HypothesisFit]) -> list[tuple[HypothesisFit, HypothesisFit]]:
    """The first trial with each other; where it is a fault of the rig, the first of the car with each too.

    Beside a strut that bends, a ride height 5 mm off gained less than a gain of the tyre load. Without its
    pair with a hub it came in four steps later, when each effect of the library was tried beside all others.
    """
    first, *others = trials
    pairs = [(first, other) for other in others]
    if EFFECTS[first.hypothesis.effect].on_rig:
        car = next((t for t in others if not EFFECTS[t.hypothesis.effect].on_rig), None)
        pairs += [(car, t) for t in others if car is not None and t is not car]
    return pairs


def own_amplitudes(trial: HypothesisFit) -> FloatArray:
    """(m,) of the trial's effect, in typical sizes."""
    return trial.fit.z[trial.fit.z.size - len(trial.hypothesis.sizes) :]


def _from_nominal(
    nominal: Fit, hypotheses: Sequence[Hypothesis], amplitudes: Sequence[FloatArray], ceiling: float
) -> FitStart:
    """ceiling: see `fit`."""
    model = nominal.model
    for hypothesis in hypotheses:
        model = model.extended(hypothesis)
    return FitStart(model, np.concatenate([nominal.z, *amplitudes]), nominal, ceiling)
