"""What a search works on: the targets of the rating, with everything else that was measured beside them.

Every measured characteristic and curve counts, unless the study takes it out (objective "measured"), or the
rating's own terms alone do (objective "thesis"). Either way nothing that was measured may move further from
its target than the largest of its interval (thesis, equations 5.1 and 5.2), three standard deviations, and
where it was: the hold. Intervals that no design reaches are widened to what can be reached.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from doe_kc.correlation.least_squares import most_probable_step
from doe_kc.correlation.likelihood import Likelihood
from doe_kc.correlation.linearization import Linearization
from doe_kc.correlation.options import ObjectiveKind
from doe_kc.correlation.reach import Relaxation
from doe_kc.targets import Constraint, CurveTarget, MisfitTerm, Objective, Score, Target, Targets
from doe_kc.targets.comparison import INTERVAL_SHARE, constraint_interval
from doe_kc.targets.improvement import SIGNIFICANT
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import Space

ROUNDING = 1e-6
"""Share by which a limit lies beyond the baseline's own distance: the baseline meets its holds."""
MISFIT_WEIGHT = 2.0
"""Of the mean squared residual, 1 for noise alone: a fit that doubles it gives away as much as one objective
that is missed by its own size. To hit all characteristics exactly one axle gave away a fifth of one."""
NEGLIGIBLE_SHARE = 0.01
"""Share of the interval's measure below which no deviation is worth removing: exact targets have no noise."""
STILL_SHARE = 0.02
"""Share of the interval's measure, a seventh of the interval, that what is not worked on may move."""
NOT_COUNTED = Objective(linear=0.0, quadratic=0.0)


def hold_distance(target: Target, baseline: float) -> float:
    """Largest distance from the target that harms nothing, in the characteristic's unit."""
    low, high = constraint_interval(target.value)
    distance = max((high - low) / 2.0, SIGNIFICANT * target.sd, abs(baseline - target.value))
    return distance * (1.0 + ROUNDING)


def hold_rms(curve: CurveTarget, baseline: float) -> float:
    """The same of a curve's RMS deviation; its interval is the share of equation 5.1 of the curve itself,
    measured from its middle: a line 15 % too steep deviates by as much."""
    middle = curve.curve - curve.curve.mean(axis=1, keepdims=True)
    own = INTERVAL_SHARE * float(np.sqrt(np.mean(middle**2)))
    return max(own, SIGNIFICANT * curve.noise, baseline) * (1.0 + ROUNDING)


def still_rms(curve: CurveTarget, baseline: float) -> float:
    """The same of a curve that is not worked on: it stays where it is."""
    return max(SIGNIFICANT * curve.noise, STILL_SHARE * curve.objective.norm, baseline) * (1.0 + ROUNDING)


def search_targets(
    targets: Targets,
    baseline: Score,
    *,
    objective: ObjectiveKind,
    relaxation: Relaxation | None = None,
    misfit: MisfitTerm | None = None,
    curves: bool = True,
) -> Targets:
    """The targets of a search that starts from a design with the score `baseline` on `all_measured(targets)`.

    misfit: the records as data beside the targets, for the objective "measured". curves: False for a solver
    that gives none; only the curves of the rating then stay.
    """
    relaxed = relaxation.distances if relaxation is not None else {}
    out_of_reach = relaxed_places(targets, relaxation)
    lines = targets.curves + (targets.others if curves else ())
    rated = {c.id for c in targets.curves}

    def line(curve: CurveTarget, rms: float) -> CurveTarget:
        place = (curve.load_case, curve.response)
        counted = curve.id in rated or (objective == "measured" and not curve.excluded)
        own = curve.objective if counted and place not in out_of_reach else None
        return replace(
            curve,
            objective=own or replace(NOT_COUNTED, norm=curve.objective.norm),
            limit=math.inf if not curve.hold else hold_rms(curve, rms) if own else still_rms(curve, rms),
        )

    return replace(
        targets,
        characteristics=tuple(
            _searched(t, float(v), objective, relaxed)
            for t, v in zip(targets.characteristics, baseline.values, strict=True)
        ),
        curves=tuple(line(c, float(r)) for c, r in zip(lines, baseline.rms, strict=True)),
        others=(),
        misfit=misfit if objective == "measured" else None,
    )


def misfit_term(
    likelihood: Likelihood, space: Space, start: Outcome, expansion: Linearization
) -> MisfitTerm | None:
    """The records as data, tempered by what the best design leaves of them to first order: deviations that no
    design explains shall not weigh more than noise. None without records or curves."""
    if not likelihood.curves or start.curves is None:
        return None
    residual = likelihood.residual(start.curves, start.characteristics)
    jacobian = likelihood.jacobian(expansion.curves, expansion.characteristics)
    step = most_probable_step(jacobian, residual, space.start, space)
    left = float(np.mean((residual + jacobian @ step) ** 2))
    return MisfitTerm(residual.size, MISFIT_WEIGHT / max(1.0, left))


def relaxed_places(targets: Targets, relaxation: Relaxation | None) -> frozenset[tuple[str, str]]:
    """(load case, response) of the targets out of reach."""
    relaxed = relaxation.distances if relaxation is not None else {}
    return frozenset(
        (t.entry.load_case, t.entry.response) for t in targets.characteristics if t.entry.id in relaxed
    )


def all_measured(targets: Targets, *, curves: bool = True) -> Targets:
    """The targets with every measured curve among their curves, to score a design by."""
    return replace(targets, curves=targets.curves + (targets.others if curves else ()), others=())


def _searched(
    target: Target, baseline: float, objective: ObjectiveKind, relaxed: Mapping[str, float]
) -> Target:
    counted = target.objective
    if counted is None and objective == "measured" and not target.excluded:
        counted = Objective(norm=target.scale)
    if counted is not None and objective == "measured" and counted.goal == "target":
        counted = replace(counted, norm=min(counted.norm, _deviation(target, baseline)))
    constraint = target.constraint
    if constraint is not None and objective == "measured" and _by_default(constraint, target):
        constraint = _widened(constraint, target.value, SIGNIFICANT * target.sd)
    if target.entry.id in relaxed:
        counted = None
        constraint = constraint and _widened(constraint, target.value, relaxed[target.entry.id])
    worked_on = counted is not None or constraint is not None
    distance = hold_distance(target, baseline) if worked_on else _still(target, baseline)
    return replace(
        target,
        objective=counted,
        constraint=constraint,
        limit=distance if target.hold else math.inf,
    )


def _still(target: Target, baseline: float) -> float:
    """Limit of what is not worked on at all: it stays where it is, rather than anywhere in its interval."""
    floor = max(SIGNIFICANT * target.sd, STILL_SHARE * target.scale)
    return max(floor, abs(baseline - target.value)) * (1.0 + ROUNDING)


def _deviation(target: Target, baseline: float) -> float:
    """What there is to remove: the baseline's distance, or what is significant where that is less."""
    floor = max(SIGNIFICANT * target.sd, NEGLIGIBLE_SHARE * target.scale)
    return max(abs(baseline - target.value), floor)


def _by_default(constraint: Constraint, target: Target) -> bool:
    """Whether the interval is that of equations 5.1 and 5.2: narrower than the noise, it asks for what the
    records do not know, as of a camber change that is nearly zero. What the study states is asked for."""
    return (constraint.low, constraint.high) == constraint_interval(target.value)


def _widened(constraint: Constraint, target: float, distance: float) -> Constraint:
    return replace(
        constraint, low=min(constraint.low, target - distance), high=max(constraint.high, target + distance)
    )
