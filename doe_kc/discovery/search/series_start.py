"""Where fits with a compliance in series with a friction begin: where it makes the loops of another set.

A friction and a spring beside it on a mount that yields make exactly the loops of smaller ones on a rigid
mount, see `doe_kc.effects._series`. A fit that begins elsewhere does not get there: the travel, the limit,
the spring and the mount have to change together.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from doe_kc.discovery.fit import Fit
from doe_kc.discovery.gauss_newton import FitStart
from doe_kc.discovery.model import EffectModel
from doe_kc.discovery.search.law_variants import amplitude_by, with_law
from doe_kc.discovery.thresholds import NEAR_RATIO, SERIES_RATIOS
from doe_kc.effects import EFFECTS
from doe_kc.effects._friction import DryFriction
from doe_kc.effects.hypothesis import Hypothesis
from doe_kc.ground.typing import FloatArray


def in_series(friction: Hypothesis, compliance: Hypothesis) -> bool:
    """Whether a friction stands on a compliance together with a spring."""
    on, part = EFFECTS[compliance.effect], EFFECTS[friction.effect].part
    return bool(on.spring) and on.part == part and isinstance(EFFECTS[friction.effect], DryFriction)


def series_starts(
    current: Fit, friction: Hypothesis, law: Hypothesis, compliance: Hypothesis, ceiling: float = np.inf
) -> Iterator[FitStart]:
    """The set of a fit with a compliance, in it already or not, of some stiffnesses other than its own, and a
    friction of it by a law, where they make nearly the loops that the fit has; with a spring that no
    parameter changes, the loops of the friction alone."""
    if in_series(friction, compliance):
        for ratio in SERIES_RATIOS:
            change, after = _ratios(current, compliance, ratio)
            if max(change, 1.0 / change) >= NEAR_RATIO and after >= NEAR_RATIO:
                point = _on_compliance(current, friction, law, compliance, change, after)
                yield FitStart(*point, current, ceiling)


def _ratios(current: Fit, compliance: Hypothesis, ratio: float) -> tuple[float, float]:
    """By how much the spring and the limit change from the fit, and from a rigid mount, at most as far as the
    spring's bounds let it."""
    stands = compliance in current.model.members
    before = 1.0 + _spring(current, compliance) / _stiffness(current, compliance) if stands else 1.0
    change, place = ratio / before, _spring_place(current, compliance)
    if place is not None:
        variable = current.model.space.variables[place]
        value = variable.value(float(current.z[place]))
        change = min(max(change, variable.lower / value), variable.upper / value)
    return change, before * change


def _on_compliance(
    current: Fit, friction: Hypothesis, law: Hypothesis, compliance: Hypothesis, change: float, after: float
) -> tuple[EffectModel, FloatArray]:
    """The set and its point. change, after: see `_ratios`."""
    model, z, effect = current.model, current.z, EFFECTS[friction.effect]
    assert isinstance(effect, DryFriction)
    known, spring = friction.options(model.sizes_at(z, friction)), _spring(current, compliance)
    numbers = effect.on_compliance(law.law or next(iter(effect.laws)), known, spring, change)
    rigid = spring * change / after
    model, z = with_law(model, z, friction, law)
    if compliance not in model.members:
        model, z = model.extended(compliance), np.append(z, np.zeros(len(compliance.sizes)))
    z = z.copy()
    place = _spring_place(current, compliance)
    if place is not None:
        variable = model.space.variables[place]
        z[place] = variable.place(change * variable.value(float(z[place])))
    for member, own in ((law, numbers), (compliance, _yielding(compliance, rigid, after))):
        for i, size in enumerate(member.sizes, start=model.place(member).start):
            z[i] = amplitude_by(size, own) if size.key in own else z[i]
    return model, z


def _spring_place(current: Fit, compliance: Hypothesis) -> int | None:
    """Place in z of the parameter by which the spring changes; None where none does."""
    paths, own = current.model.space.paths, EFFECTS[compliance.effect].spring[-1]
    return paths.index(own) if own in paths else None


def _spring(current: Fit, compliance: Hypothesis) -> float:
    """N/mm, of the spring beside the frictions as the fit has it."""
    axle = current.model.axle_at(current.z)
    return math.prod(axle.values[path] for path in EFFECTS[compliance.effect].spring)


def _stiffness(current: Fit, compliance: Hypothesis) -> float:
    """N/mm, of a compliance of the set."""
    own = zip(compliance.sizes, current.z[current.model.place(compliance)].tolist(), strict=True)
    return next(size.value(a) for size, a in own if size.growth == "compliance")


def _yielding(compliance: Hypothesis, rigid: float, ratio: float) -> dict[str, float]:
    """Options of a compliance on which springs are a ratio stiffer than the same on a rigid one are, rigid
    N/mm."""
    key = next(size.key for size in compliance.sizes if size.growth == "compliance")
    return {key: rigid * ratio / (ratio - 1.0)}
